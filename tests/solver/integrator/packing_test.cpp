// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How densely points are packed: 1 where they lie as they were released, twice that where two lie in the room of one.
#include "solver/integrator/packing.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "solver/options/solve.hpp"
#include "tests/solver/scenes.hpp"
#include "tests/solver/small_grid.hpp"

namespace talus::solver::testing {
namespace {

class PackedPoints : public InEachPlace {
 protected:
  static Packing packing(const Domain& domain, ShapeKind shape, Mapping mapping = Mapping::terrain_following) {
    SolveOptions o;
    o.shape = shape;
    o.mapping = mapping;
    const auto solver = make_solver(make_scene(domain, o), o, GetParam());
    return solver->packing();
  }
};

constexpr ShapeKind all_shapes[] = {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp};

TEST_P(PackedPoints, on_a_lattice_fill_their_room) {
  Domain d = ground(24, 24, 1.0, 0.5, [](double x, double y) { return 0.2 * x - 0.1 * y; });
  fill(d, {6, 18, 6, 18, 0, 3}, 2, 2);
  for (const ShapeKind shape : all_shapes) {
    SCOPED_TRACE(name_of(shape));
    const Packing found = packing(d, shape);
    // Two points a cell lie a quarter of a cell to either side of a node, one in the half cell on the bed. Volumes are
    // whole parts of 2^-24 of a cell.
    EXPECT_NEAR(found.largest, 1, 1e-6);
    EXPECT_NEAR(found.p99, 1, 1e-6);
    EXPECT_LE(found.p99, found.largest);
  }
}

TEST_P(PackedPoints, twice_in_the_room_of_one_are_packed_twice) {
  Domain d = ground(24, 24, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {6, 18, 6, 18, 0, 3}, 2, 2);
  const Packing once = packing(d, ShapeKind::quadratic);
  fill(d, {6, 18, 6, 18, 0, 3}, 2, 2);
  const Packing twice = packing(d, ShapeKind::quadratic);
  EXPECT_NEAR(twice.largest, 2 * once.largest, 1e-6);
  EXPECT_NEAR(twice.p99, 2 * once.p99, 0.02) << "within two bins";
}

TEST_P(PackedPoints, far_denser_in_a_few_nodes_do_not_show_in_the_percentile) {
  Domain d = ground(64, 24, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {6, 56, 6, 18, 0, 3}, 2, 2);
  fill(d, {30, 31, 11, 12, 1, 1.5}, 2, 2);  // a cell of 3600, about cells that hold no hundredth
  const Packing found = packing(d, ShapeKind::quadratic);
  EXPECT_GT(found.largest, 1.2);
  EXPECT_LT(found.p99, 1.05);
}

TEST_P(PackedPoints, are_measured_alike_on_a_cartesian_grid) {
  Domain d = ground(24, 24, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {6, 18, 6, 18, 0, 3}, 2, 2);
  const Packing follows = packing(d, ShapeKind::quadratic),
                level = packing(d, ShapeKind::quadratic, Mapping::cartesian);
  EXPECT_NEAR(level.largest, follows.largest, 1e-6);
}
TALUS_IN_EACH_PLACE(PackedPoints);

TEST(Packing, of_a_point_gives_all_of_its_volume_to_cells_and_bins) {
  const SmallGrid grid;
  for (OnePoint& point : some_points()) {
    std::vector<CellParts> parts(SmallGrid::nodes), bins(packing_bins);
    std::uint32_t most = 0;
    ScatterParts<double>{grid.view(), point.view(), parts.data()}(0);
    const double cell = 2 * 2 * 0.5;
    const auto expected = static_cast<double>(point.volume / cell * parts_of_cell);
    const auto held = static_cast<double>(std::accumulate(parts.begin(), parts.end(), CellParts{}));
    EXPECT_NEAR(held, expected, 0.5);
    const BinPacking<double> kernel{grid.view(), grid.active.data(), parts.data(), bins.data(), &most};
    for (int c = 0; c < 4 * block_columns; ++c) kernel(c);
    EXPECT_EQ(std::accumulate(bins.begin(), bins.end(), CellParts{}),
              std::accumulate(parts.begin(), parts.end(), CellParts{}));
  }
}

TEST(Packing, percentile_leaves_a_hundredth_of_the_volume_above) {
  std::vector<CellParts> bins(packing_bins);
  bins[100] = 9900;
  bins[250] = 100;
  EXPECT_DOUBLE_EQ(packing_of(bins, 2.505).p99, 1.01);
  bins[250] = 102;
  EXPECT_DOUBLE_EQ(packing_of(bins, 2.505).p99, 2.505) << "the upper end of its bin, no more than the largest";
  EXPECT_EQ(packing_of(std::vector<CellParts>(packing_bins), 0).p99, 0);
}

}  // namespace
}  // namespace talus::solver::testing
