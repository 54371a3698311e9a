// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Preconditioners and the tangent's products: solutions that do not depend on them, and iterations that do.
#include <cstdio>

#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

class Preconditioners : public InEachPlace {
 protected:
  template <class Real, class Device, class Shape>
  static void give_one_solution() {
    for (const bool b_bar : {false, true}) {
      LinearBench<Real, Device, Shape> bench(
          {kind_of<Shape>, Mapping::terrain_following, MaterialModel::hencky, b_bar, true});
      const auto expected = bench.by_cholesky();
      EXPECT_LT(difference(bench.by_gradients(), expected), 1e-8);
    }
  }

  /// Iterations to a thousandth for a slab of four layers h / aspect high on 32 x 28 cells, in steps of so many
  /// horizontal CFL steps.
  template <class Real, class Device, class Shape>
  static int iterations(double over_cfl, double aspect) {
    constexpr double h = 2;
    Domain d = ground(44, 40, h, h / aspect, [](double, double) { return 0.0; });
    fill(d, {10, 74, 10, 66, 0, 4 * h / aspect});
    SolveOptions o;
    o.shape = kind_of<Shape>;
    LinearBench<Real, Device, Shape> bench(make_scene(d, o), {kind_of<Shape>});
    bench.lay_down();
    const double step = over_cfl * h / static_cast<double>(bench.materials.list[0].wave_speed);
    bench.inertia = 4 / (step * step);
    int count = 0;
    bench.by_gradients(&count, 1e-3);
    return count;
  }

  template <class Real, class Device, class Shape>
  static void count_in_thin_layers() {
    std::printf("  CG iterations at 5 horizontal CFL steps, %s functions; vertical: 5, 15, 50\n",
                name_of(kind_of<Shape>));
    int count[3];
    const double aspects[3] = {1, 3, 10};
    for (int a = 0; a < 3; ++a) count[a] = iterations<Real, Device, Shape>(5, aspects[a]);
    std::printf("    %4d %4d %4d\n", count[0], count[1], count[2]);
    EXPECT_GT(count[2], 4 * count[0]) << "thin layers cost nothing: the test shows nothing";
  }

  template <class Real, class Device, class Shape>
  static void count_in_long_steps() {
    std::printf("  CG iterations at 5, 15, 50 CFL steps, horizontal and vertical, %s functions\n",
                name_of(kind_of<Shape>));
    int count[3];
    const double steps[3] = {5, 15, 50};
    for (int a = 0; a < 3; ++a) count[a] = iterations<Real, Device, Shape>(steps[a], 1);
    std::printf("    %4d %4d %4d\n", count[0], count[1], count[2]);
    EXPECT_GT(count[2], 4 * count[0]) << "long steps cost nothing: the test shows nothing";
  }

  /// validation.md C3: half of a slab 1e4 times as stiff, or 100 times as heavy, or both, in steps of five CFL steps of
  /// the soft half.
  template <class Real, class Device, class Shape>
  static void count_with_contrasts() {
    constexpr double h = 2;
    Domain d = ground(24, 20, h, h, [](double, double) { return 0.0; });
    fill(d, {10, 36, 10, 30, 0, 4 * h});
    SolveOptions o;
    o.shape = kind_of<Shape>;
    const Scene scene = make_scene(d, o);
    struct Contrast {
      double stiffness, density;
    };
    constexpr Contrast contrasts[] = {{1, 1}, {1e4, 1}, {1, 100}, {1e4, 100}};
    std::printf(
        "  CG iterations to 1e-8, %s functions; stiffness and density of one half: 1 and 1, 1e4 and 1, 1 and 100, 1e4 "
        "and 100\n",
        name_of(kind_of<Shape>));
    for (const Contrast& c : contrasts) {
      LinearBench<Real, Device, Shape> bench(scene, {kind_of<Shape>});
      bench.lay_down();
      const double step = 5 * h / static_cast<double>(bench.materials.list[0].wave_speed);
      bench.inertia = 4 / (step * step);
      bench.contrast(12, c.stiffness, c.density);
      int count = 0;
      const auto solution = bench.by_gradients(&count, 1e-8);
      std::printf(" %5d", count);
      EXPECT_LT(difference(solution, bench.by_cholesky()), 1e-6);
    }
    std::printf("\n");
  }
};

TEST_P(Preconditioners, give_one_solution) { TALUS_RUN(give_one_solution); }
TEST_P(Preconditioners, need_more_iterations_in_thin_layers) { TALUS_RUN(count_in_thin_layers); }
TEST_P(Preconditioners, need_more_iterations_in_long_steps) { TALUS_RUN(count_in_long_steps); }

TEST_P(Preconditioners, converge_in_a_body_of_two_stiffnesses) { TALUS_RUN(count_with_contrasts); }

TALUS_IN_EACH_PLACE(Preconditioners);

class TangentForms : public InEachPlace {
 protected:
  template <class Real, class Device, class Shape>
  static void narrow() {
    for (const auto mapping : {Mapping::terrain_following, Mapping::cartesian}) {
      for (const auto model : {MaterialModel::hencky, MaterialModel::drucker_prager}) {
        LinearBench<Real, Device, Shape> bench({kind_of<Shape>, mapping, model});
        const auto expected = bench.product();
        EXPECT_GT(norm(expected), 0);
        // Rounded to 2^-24 each: a part in a million, but not none.
        const double rounding = difference(bench.product(true), expected);
        EXPECT_LT(rounding, 1e-6);
        EXPECT_GT(rounding, 1e-12) << "stored in double after all";
      }
    }
  }
};

TEST_P(TangentForms, tangents_in_single_precision_are_rounded_and_no_more) { TALUS_RUN(narrow); }

TALUS_IN_EACH_PLACE(TangentForms);

#if TALUS_FOR_GPU
class ProductsOnBothDevices : public InEachPlace {
 protected:
  template <class Shape>
  static void compare() {
    LinearBench<double, CpuDevice, Shape> cpu({kind_of<Shape>});
    LinearBench<double, GpuDevice, Shape> gpu({kind_of<Shape>});
    EXPECT_LT(difference(gpu.product(), cpu.product()), 1e-11);
  }
};
TEST_P(ProductsOnBothDevices, give_the_same_products) {
  compare<Linear>();
  compare<Quadratic>();
  compare<Gimp>();
}
INSTANTIATE_TEST_SUITE_P(places, ProductsOnBothDevices, ::testing::Values(On::gpu), place_name);
#endif

TEST(TangentProducts, are_the_same_on_every_run) {
  LinearBench<double, CpuDevice, Quadratic> bench({ShapeKind::quadratic});
  const auto a = bench.product(), b = bench.product();
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_TRUE(a[n].x == b[n].x && a[n].y == b[n].y && a[n].z == b[n].z);
}

}  // namespace
}  // namespace talus::solver::testing
