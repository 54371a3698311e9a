// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <set>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/tally.hpp"
#include "common/map/raster.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

TEST(Footprint, comes_back_as_it_went_and_counts_the_cells_thicker_than_the_threshold) {
  for (const std::vector<double>& thickness_map :
       {std::vector<double>{0, 0, 1, 2, 0}, {1, 1, 1}, {0, 0}, {nan, 3, nan, 3}, {}}) {
    const auto cells = cells_of(footprint_of(thickness_map, 0.5), thickness_map.size());
    ASSERT_EQ(cells.size(), thickness_map.size());
    for (std::size_t n = 0; n < cells.size(); ++n) EXPECT_EQ(cells[n] != 0, thickness_map[n] > 0.5) << "cell " << n;
  }
  EXPECT_EQ(footprint_of(std::vector<double>{0.5, 0.51}, 0.5), (Footprint{1, 1}));
  EXPECT_EQ(covered_cells(footprint_of(std::vector<double>{1, 0, 1, 1, nan, 2}, 0.5)), 4);
  EXPECT_EQ(covered_cells(footprint_of(std::vector<double>{0, 0}, 0.5)), 0);
  EXPECT_EQ(covered_cells({}), 0);
}

/// Values of one cell over the members, log-normal from some centimetres to some tens of metres.
std::vector<double> draws(int count, unsigned seed, double share_absent = 0) {
  std::mt19937_64 random(seed);
  std::lognormal_distribution<double> thickness(0.3, 1.1);
  std::uniform_real_distribution<double> uniform;
  std::vector<double> values;
  for (int k = 0; k < count; ++k) {
    const double value = thickness(random);
    values.push_back(uniform(random) < share_absent ? 0.0 : value);
  }
  return values;
}

MapTally tally_of(const CountedMap& map, const std::vector<double>& values, std::vector<double> thresholds) {
  MapTally tally(std::move(thresholds), 1);
  for (const double value : values) tally.add(map, bin_edges(map), 0, value);
  return tally;
}

/// The smallest value that a share of the members does not exceed.
double exact_quantile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(std::ceil(share * static_cast<double>(values.size()))) - 1];
}

constexpr std::size_t same_cell[] = {0};

const CountedMap& thickness = counted_maps[0];
const CountedMap& arrival = counted_maps[4];

TEST(MapTally, counts_members_above_and_arrivals_before_each_threshold_with_the_threshold_itself) {
  const auto tally = tally_of(thickness, {0, 0.4999, 0.5, 0.7, nan, 3}, {0.5, 1});
  EXPECT_EQ(tally.exceeded[0][0], 3u) << "0.5 itself counts";
  EXPECT_EQ(tally.exceeded[1][0], 1u);
  EXPECT_EQ(tally.reached[0], 4u) << "0 and NaN say that nothing came";
  const auto times = tally_of(arrival, {0, 10, 10.01, nan}, {10, 60});
  EXPECT_EQ(times.exceeded[0][0], 2u) << "0 s is a time, and 10 s is not later than 10 s";
  EXPECT_EQ(times.exceeded[1][0], 3u);
  EXPECT_EQ(times.reached[0], 3u);
}

TEST(MapTally, gives_mean_and_deviation_to_half_a_quantum) {
  const auto values = draws(500, 3, 0.2);
  const auto tally = tally_of(thickness, values, {1});
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / 500;
  double squares = 0;
  for (const double v : values) squares += (v - mean) * (v - mean);
  EXPECT_NEAR(tally.mean(thickness, 0, 500), mean, 0.5e-3);
  EXPECT_NEAR(tally.deviation(thickness, 0, 500), std::sqrt(squares / 500), 0.5e-3);
}

TEST(MapTally, takes_times_over_the_members_that_arrive_and_quantiles_while_enough_do) {
  const auto tally = tally_of(arrival, {10, 20, nan, nan}, {});
  EXPECT_NEAR(tally.mean(arrival, 0, 4), 15, 1e-9);
  EXPECT_NEAR(tally.deviation(arrival, 0, 4), 5, 1e-9);
  EXPECT_TRUE(std::isnan(tally_of(arrival, {nan}, {}).mean(arrival, 0, 1)));
  const auto early = tally_of(arrival, {10, 10, 10, nan}, {});
  EXPECT_NEAR(early.quantile(arrival, 0, 0.5, 4), 10, 10 * (arrival.ratio - 1));
  EXPECT_TRUE(std::isnan(early.quantile(arrival, 0, 0.9, 4))) << "a quarter never arrives";
}

TEST(MapTally, gives_quantiles_within_the_ratio_of_its_bins) {
  for (const unsigned seed : {1u, 2u, 3u})
    for (const double absent : {0.0, 0.3}) {
      const auto values = draws(2000, seed, absent);
      const auto tally = tally_of(thickness, values, {1});
      for (const double share : {0.05, 0.35, 0.5, 0.95, 0.99}) {
        const double exact = exact_quantile(values, share), found = tally.quantile(thickness, 0, share, 2000);
        if (exact == 0) {
          EXPECT_EQ(found, 0) << "share " << share;
          continue;
        }
        EXPECT_LE(found, exact * thickness.ratio + 1e-3) << "share " << share << ", seed " << seed;
        EXPECT_GE(found, exact / thickness.ratio - 1e-3) << "share " << share << ", seed " << seed;
      }
    }
}

TEST(MapTally, gives_the_same_bits_in_any_order_and_in_any_parts) {
  const auto values = draws(300, 9, 0.1);
  const MapTally whole = tally_of(thickness, values, {0.5, 2});
  std::mt19937_64 random(4);
  for (int round = 0; round < 5; ++round) {
    auto shuffled = values;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    const auto cut = static_cast<std::ptrdiff_t>(random() % 300);
    MapTally first = tally_of(thickness, {shuffled.begin(), shuffled.begin() + cut}, {0.5, 2});
    first.add(thickness, tally_of(thickness, {shuffled.begin() + cut, shuffled.end()}, {0.5, 2}), same_cell);
    test::expect_same(first, whole, &MapTally::exceeded, &MapTally::extreme, &MapTally::sum, &MapTally::sum_of_squares);
    const auto ours = first.histograms.of(0), theirs = whole.histograms.of(0);
    EXPECT_TRUE(std::equal(ours.begin(), ours.end(), theirs.begin(), theirs.end()));
  }
}

TEST(MapTally, does_not_overflow_with_a_million_members_of_the_largest_value) {
  MapTally tally({1}, 1), million({1}, 1);
  for (int k = 0; k < 1000; ++k) tally.add(thickness, bin_edges(thickness), 0, 1e9);
  for (int k = 0; k < 1000; ++k) million.add(thickness, tally, same_cell);
  EXPECT_EQ(million.reached[0], 1'000'000u);
  EXPECT_NEAR(million.mean(thickness, 0, 1'000'000), 3000, 1e-9) << "the largest that is counted";
  EXPECT_NEAR(million.deviation(thickness, 0, 1'000'000), 0, 1e-3);
}

TEST(MapTally, keeps_the_largest_value_and_of_a_time_the_smallest_and_refuses_counts_of_other_maps) {
  const auto tally = tally_of(thickness, {0.4, 3.0004, 0, nan, 2}, {});
  EXPECT_NEAR(tally.largest(thickness, 0), 3.0004, 0.5e-3) << "to half a quantum";
  EXPECT_NEAR(tally_of(arrival, {nan, 12, 7.5, 60}, {}).largest(arrival, 0), 7.5, 0.5e-2);
  EXPECT_EQ(tally_of(thickness, {0, nan}, {}).largest(thickness, 0), 0) << "nobody came";
  EXPECT_TRUE(std::isnan(tally_of(arrival, {nan}, {}).largest(arrival, 0)));
  MapTally two({1}, 2);
  EXPECT_THROW(two.add(thickness, MapTally({1}, 3), same_cell), std::logic_error);
  EXPECT_THROW(two.add(thickness, MapTally({2}, 1), same_cell), std::logic_error);
}

TEST(MapTally, of_different_things_keeps_no_distribution_and_the_same_counts) {
  const auto values = draws(200, 5, 0.3);
  const MapTally whole = tally_of(thickness, values, {0.5, 2});
  MapTally bare({0.5, 2}, 1, Tallied::largest);
  for (const double value : values) bare.add(thickness, bin_edges(thickness), 0, value);
  test::expect_same(bare, whole, &MapTally::exceeded, &MapTally::reached, &MapTally::extreme);
  EXPECT_TRUE(bare.sum.empty());
  EXPECT_THROW(bare.add(thickness, whole, same_cell), std::logic_error) << "they cannot be added up";
}

TEST(BinEdges, grow_for_every_map_and_reach_what_flows_do) {
  for (const CountedMap& map : counted_maps) {
    const auto edges = bin_edges(map);
    EXPECT_TRUE(std::is_sorted(edges.begin(), edges.end(), std::less_equal<>())) << map.name;
    const double last = map.quantum * static_cast<double>(edges.back());
    EXPECT_GT(last, std::string(map.unit) == "m" ? 200 : std::string(map.unit) == "m s-1" ? 300 : 2000) << map.name;
  }
}

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

TEST(KeptCells, hold_only_blocks_to_which_something_came_in_one_order_whichever_came_first) {
  KeptCells cells(grid_of(20000, 20000));
  cells.keep(19999, 19999);
  cells.keep(19990, 19998);
  cells.keep(0, 0);
  EXPECT_EQ(cells.count(), 2 * KeptCells::of_block);
  EXPECT_EQ(cells.find(500, 500), KeptCells::none);
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

TEST(EnsembleCounts, refuse_a_member_of_other_cells_and_name_those_that_came_to_an_edge) {
  EnsembleCounts counts = empty_counts(test::ensemble_scene(), 2, {0, 2}, {});
  RunMaps maps = test::member_maps(counts.scene, 8, 1);
  maps.grid.west += 3;
  EXPECT_THROW(counts.add(0, maps, {}), std::logic_error) << "between the cells";
  maps.grid.west += 7;
  EXPECT_THROW(counts.add(0, maps, {}), std::logic_error) << "beyond the edge";
  EnsembleCounts all = empty_counts(test::ensemble_scene(), 3, {0, 3}, {});
  const RunMaps whole = test::member_maps(all.scene, 8, 1);
  all.add(0, whole, {.edge_cells = 0});
  all.add(1, whole, {.edge_cells = 2});
  all.add(2, whole, {.volume_outflow = 1, .edge_cells = 0});
  EXPECT_EQ(all.at_edge(), (std::vector<std::int64_t>{1, 2}));
}

}  // namespace
}  // namespace talus
