// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The tangent's products on random points, states and constraints.
#include "solver/linear/operator/tangent_operator.hpp"

#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

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
