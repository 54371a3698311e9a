// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/kept_cells.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include "common/map/crop.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/ensemble/same_maps.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

MapGrid grid_of(int columns, int rows) {
  return {.columns = columns, .rows = rows, .west = 600000, .south = 5100000, .cell = 10, .crs_wkt = ""};
}

TEST(KeptCells, give_every_cell_a_place_of_its_own_and_tell_it_back) {
  KeptCells cells(grid_of(37, 21));  // no whole number of blocks
  std::set<std::size_t> places;
  for (int row = 20; row >= 0; --row)
    for (int column = 0; column < 37; ++column) {
      const std::size_t place = cells.keep(column, row);
      EXPECT_TRUE(places.insert(place).second) << column << ", " << row;
      EXPECT_EQ(cells.find(column, row), place);
      EXPECT_EQ(cells.cell(place), (std::array{column, row}));
    }
  EXPECT_EQ(cells.blocks().size(), 6u);
}

TEST(KeptCells, hold_only_blocks_to_which_something_came) {
  KeptCells cells(grid_of(20000, 20000));
  cells.keep(19999, 19999);
  cells.keep(19990, 19998);
  cells.keep(0, 0);
  EXPECT_EQ(cells.count(), 2 * KeptCells::of_block);
  EXPECT_EQ(cells.find(500, 500), KeptCells::none);
}

TEST(KeptCells, stand_in_one_order_whichever_came_first) {
  KeptCells one(grid_of(64, 64)), other(grid_of(64, 64));
  for (const auto& [column, row] : {std::pair{40, 2}, {3, 50}, {17, 17}}) one.keep(column, row);
  for (const auto& [column, row] : {std::pair{17, 17}, {40, 2}, {3, 50}}) other.keep(column, row);
  const auto a = one.in_order(), b = other.in_order();
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t n = 0; n < a.size(); ++n) EXPECT_EQ(one.cell(a[n]), other.cell(b[n]));
}

TEST(KeptCells, spread_over_the_grid_leave_the_rest_as_it_is_said) {
  KeptCells cells(grid_of(20, 18));
  const std::size_t place = cells.keep(18, 17);
  std::vector<int> values(cells.count(), 0);
  values[place] = 7;
  const std::vector<int> all = cells.spread(values, -1);
  ASSERT_EQ(all.size(), 360u);
  EXPECT_EQ(all[17 * 20 + 18], 7);
  EXPECT_EQ(all[17 * 20 + 16], 0) << "in the block";
  EXPECT_EQ(all[0], -1) << "in no block";
}

/// Counts of members whose maps lie each in a window of a larger grid: those of counting them on the larger grid.
TEST(EnsembleCounts, of_windows_are_those_of_the_whole_grid) {
  const MemberTable table = test::ensemble_table(8);
  const EnsembleScene small = test::ensemble_scene();
  EnsembleScene large = small;
  large.grid = cut(small.grid, {-30, -20, 100, 90});
  large.terrain.clear();
  large.before.clear();
  large.release_thickness.clear();
  const ThresholdOptions thresholds;
  EnsembleCounts by_window = empty_counts(large, 8, {0, 8}, thresholds), whole = by_window;
  for (std::int64_t k = 0; k < 8; ++k) {
    RunMaps maps = test::member_maps(small, test::reach_of(table, k), test::depth_of(table, k));
    const int shift = static_cast<int>(2 * k);
    maps.grid = cut(small.grid, {shift, -shift, small.grid.columns, small.grid.rows});
    by_window.add(k, maps, test::result_of(table, k));
    EXPECT_EQ(by_window.windows[static_cast<std::size_t>(k)].column, 30 + shift);
    EXPECT_EQ(by_window.windows[static_cast<std::size_t>(k)].row, 20 - shift);
    RunMaps spread;
    spread.grid = large.grid;
    spread.initial_thickness = cut_to({maps.grid, maps.initial_thickness}, large.grid).values;
    for (const CountedMap& map : counted_maps)
      spread.*(map.values) = cut_to({maps.grid, maps.*(map.values)}, large.grid).values;
    whole.add(k, spread, test::result_of(table, k));
  }
  test::expect_same_maps(by_window, whole);
  EXPECT_LT(by_window.cells.count(), large.grid.count()) << "and only where members came";
  const test::Scratch scratch;
  write_counts(scratch / "counts.h5", by_window);
  const EnsembleCounts read = read_counts(scratch / "counts.h5");
  test::expect_same_maps(read, by_window);
  EXPECT_EQ(read.flow, by_window.flow);
  EXPECT_EQ(read.windows[3].column, by_window.windows[3].column);
}

TEST(EnsembleCounts, refuse_a_member_whose_cells_are_not_those_of_the_grid) {
  EnsembleCounts counts = empty_counts(test::ensemble_scene(), 2, {0, 2}, {});
  RunMaps maps = test::member_maps(counts.scene, 8, 1);
  maps.grid.west += 3;
  EXPECT_THROW(counts.add(0, maps, {}), std::logic_error) << "between the cells";
  maps.grid.west += 7;
  EXPECT_THROW(counts.add(0, maps, {}), std::logic_error) << "beyond the edge";
}

TEST(EnsembleCounts, name_the_members_that_came_to_an_edge) {
  EnsembleCounts counts = empty_counts(test::ensemble_scene(), 3, {0, 3}, {});
  const RunMaps maps = test::member_maps(counts.scene, 8, 1);
  counts.add(0, maps, {.edge_cells = 0});
  counts.add(1, maps, {.edge_cells = 2});
  counts.add(2, maps, {.volume_outflow = 1, .edge_cells = 0});
  EXPECT_EQ(counts.at_edge(), (std::vector<std::int64_t>{1, 2}));
}

}  // namespace
}  // namespace talus
