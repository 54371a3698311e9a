// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elements: the points that share a stencil, and their nodes.
#include "solver/elements/element_list.hpp"

#include <set>

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

}  // namespace
}  // namespace talus::solver::testing
