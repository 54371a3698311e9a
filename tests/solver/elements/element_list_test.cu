// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elements: the points that share a stencil, their nodes and sums; B-bar and the springs of nearly empty nodes.
#include "solver/elements/element_list.hpp"

#include <set>

#include "solver/elements/element_sums.hpp"
#include "solver/elements/mean_dilation.hpp"
#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

template <class Shape>
void check_elements() {
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list(bench.device);
  list.build(bench.grid.view(), bench.points.view());
  const ElementView v = list.view();
  constexpr int each = ElementList<double, CpuDevice, Shape>::nodes_each;
  std::vector<int> seen(static_cast<std::size_t>(bench.points.count()));
  int folded = 0;
  for (int e = 0; e < v.count; ++e) {
    EXPECT_LT(v.starts[e], v.starts[e + 1]);
    folded += v.nodes[e * each] == v.nodes[e * each + 1] ? 1 : 0;
    for (int s = v.starts[e]; s < v.starts[e + 1]; ++s) {
      const PointGradients<double, Shape> g(bench.grid.view(), bench.points.view(), v.order[s]);
      ++seen[static_cast<std::size_t>(v.order[s])];
      int local = 0;
      around(bench.grid.view(), g, [&](int n, int, int, int) { EXPECT_EQ(n, v.nodes[e * each + local++]); });
    }
  }
  for (const int times : seen) EXPECT_EQ(times, 1);
  EXPECT_EQ(folded > 0, Shape::width == 3);
  int grouped = 0;
  for (const auto& colour : list.groups().ranges) {
    std::set<int> taken;  // by earlier ranges of this colour
    for (const auto& [begin, end] : colour) {
      std::set<int> mine(v.nodes + begin * each, v.nodes + end * each);
      for (const int n : mine) EXPECT_EQ(taken.count(n), 0u);
      taken.insert(mine.begin(), mine.end());
      grouped += end - begin;
    }
  }
  EXPECT_EQ(grouped, v.count);
}

TEST(Elements, hold_every_point_once_and_share_no_node_within_a_colour) {
  check_elements<Linear>();
  check_elements<Quadratic>();
  check_elements<Gimp>();
}

/// Keeps the blocks it is handed.
template <int nodes>
struct Keep {
  double* blocks;
  void put(int e, int a, int b, const double* block) const {
    const int of_element = (a * nodes + b) * 9, each = nodes * nodes * 9;
    std::copy(block, block + 9, blocks + static_cast<std::size_t>(e) * each + of_element);
  }
};

template <class Shape>
void check_tiles() {
  constexpr int w = Shape::width, nodes = w * w * w;
  LinearBench<double, CpuDevice, Shape> bench({kind_of<Shape>});
  ElementList<double, CpuDevice, Shape> list(bench.device);
  list.build(bench.grid.view(), bench.points.view());
  const auto size = static_cast<std::size_t>(list.count()) * nodes * nodes * 9;
  std::vector<double> whole(size), slices(size);
  sum_elements<double, CpuDevice, Shape>(list, bench.from(), Keep<nodes>{whole.data()});
  using Slice = SumElements<double, Shape, 1, w * w, Keep<nodes>>;
  const Slice slice{bench.from(), list.view(), {slices.data()}};
  for (int i = 0; i < list.count() * Slice::tiles; ++i) slice(i);
  double worst = 0, largest = 0;
  for (std::size_t i = 0; i < size; ++i) {
    worst = std::max(worst, std::abs(whole[i] - slices[i]));
    largest = std::max(largest, std::abs(whole[i]));
  }
  EXPECT_LT(worst, 1e-13 * largest);
}

TEST(Elements, are_the_same_from_the_tiles_of_the_gpu) {
  check_tiles<Linear>();
  check_tiles<Quadratic>();
  check_tiles<Gimp>();
}

/// x = a motion linear in the nodes' indices. One thread: one column.
template <class Real>
struct SetAffinely {
  GridView<Real> grid;
  Vec3<double>* x;
  TALUS_HD void operator()(int column) const {
    const int i = column % grid.columns, j = column / grid.columns;
    const BlockSlot slot = grid.slot(i, j);
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
      x[GridView<Real>::node(slot, i, j, k)] = {0.1 * j - 0.2 * k + 1, -0.1 * i + 0.05 * k, 0.2 * i + 0.3 * j};
    }
  }
};

class ElementTerms : public InEachPlace {
 protected:
  static constexpr Setting with(ShapeKind shape, MaterialModel model) {
    return {shape, Mapping::terrain_following, model, true, true};
  }

  template <class Real, class Device, class Shape>
  static void compare_forms() {
    for (const auto model : {MaterialModel::hencky, MaterialModel::drucker_prager}) {
      LinearBench<Real, Device, Shape> bench(with(kind_of<Shape>, model));
      const auto expected = bench.product();
      LinearBench<Real, Device, Shape> plain({kind_of<Shape>, Mapping::terrain_following, model});
      EXPECT_GT(difference(plain.product(), expected), 1e-3) << "the terms do nothing";
    }
  }

  /// Central differences of the force against the product, for elastic points: a yielding one holds its friction's
  /// pressure.
  template <class Real, class Device, class Shape>
  static void differentiate() {
    LinearBench<Real, Device, Shape> bench(with(kind_of<Shape>, MaterialModel::hencky));
    const auto product = bench.product();
    const auto start = bench.u.download();
    const auto direction = random_vectors(bench.count, 1, 5);  // that of product()
    const auto force = [&](double step) {
      std::vector<Vec3<double>> moved(start.size());
      for (std::size_t n = 0; n < start.size(); ++n) moved[n] = start[n] + direction[n] * step;
      bench.u.upload(moved);
      bench.measure_stress();
      return bench.internal.download();
    };
    constexpr double step = 1e-6;
    auto slope = force(step);
    const auto back = force(-step);
    for (std::size_t n = 0; n < slope.size(); ++n) slope[n] = (slope[n] - back[n]) * (0.5 / step);
    EXPECT_LT(difference(slope, product), 1e-7);  // step squared times the curvature, and rounding over the step
  }

  /// A motion that linear functions hold, turn and strain included, must not feel the springs of quadratic ones.
  template <class Real, class Device, class Shape>
  static void move_affinely() {
    Domain d = ground(14, 14, 1.0, 1.0, [](double, double) { return 0.0; });
    fill(d, {5, 8, 5, 8, 3, 6});
    SolveOptions o;
    o.shape = kind_of<Shape>;
    o.mapping = Mapping::cartesian;
    LinearBench<Real, Device, Shape> bench(make_scene(d, o),
                                           {kind_of<Shape>, Mapping::cartesian, MaterialModel::hencky, false, true});
    std::vector<Vec3<double>> x(static_cast<std::size_t>(bench.count)), none(x.size());
    NodeVector<Device> u(bench.device), y(bench.device);
    u.upload(none);
    for_each(bench.device, d.grid.columns * d.grid.rows, SetAffinely<Real>{bench.grid.view(), u.data()});
    x = u.download();
    y.upload(none);
    apply_springs(bench.elements, bench.springs, u, y);
    if (Shape::width == 3) {
      EXPECT_LT(norm(y.download()), 1e-12 * 1e6 * norm(x));
    } else {
      EXPECT_GT(norm(y.download()), 0);  // hats hold to the fullest node: only a shift is free
    }
    for (auto& v : x) v = {1, 2, 3};
    u.upload(x);
    y.upload(none);
    apply_springs(bench.elements, bench.springs, u, y);
    EXPECT_LT(norm(y.download()), 1e-12 * 1e6 * norm(x));
    for (auto& v : x) v = {0, 0, 0};
    const auto mass = bench.mass.download();
    for (std::size_t n = 0; n < mass.size(); ++n) {
      if (mass[n] > 0 && mass[n] < bench.springs.light) x[n] = {1, 0, 0};
    }
    u.upload(x);
    apply_springs(bench.elements, bench.springs, u, y);
    EXPECT_GT(norm(y.download()), 1) << "no node is held";
  }
};

TEST_P(ElementTerms, have_the_same_product_by_points_and_elements) { TALUS_RUN(compare_forms); }
TEST_P(ElementTerms, are_the_derivative_of_their_force) { TALUS_RUN(differentiate); }
TEST_P(ElementTerms, let_a_body_move_as_a_whole) { TALUS_RUN(move_affinely); }

TALUS_IN_EACH_PLACE(ElementTerms);

}  // namespace
}  // namespace talus::solver::testing
