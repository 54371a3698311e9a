// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grids and what is computed on them: cutting, polygons, places, statistics, reach, random fields.
#include <algorithm>
#include <numbers>

#include <gtest/gtest.h>

#include "common/gis/resampling.hpp"
#include "common/map/fourier.hpp"
#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/map/usual_reach.hpp"
#include "tests/common/rasters.hpp"

namespace talus {
namespace {

const MapGrid grid{5, 4, 500000, 5400000, 2.5, ""};

/// Each cell of `part` holds what `whole` holds at that place, and NaN where `whole` has no cell.
void expect_same_places(const Raster& part, const Raster& whole) {
  std::size_t outside = 0;
  for (int row = 0; row < part.grid.rows; ++row)
    for (int column = 0; column < part.grid.columns; ++column) {
      const int c = static_cast<int>(std::floor((part.grid.x(column) - whole.grid.west) / whole.grid.cell)),
                r = static_cast<int>(std::floor((part.grid.y(row) - whole.grid.south) / whole.grid.cell));
      const bool inside = c >= 0 && r >= 0 && c < whole.grid.columns && r < whole.grid.rows;
      outside += !inside;
      const double value = part.at(column, row);
      EXPECT_TRUE(inside ? value == whole.at(c, r) : std::isnan(value)) << column << ", " << row;
    }
  EXPECT_EQ(part.values.size(), part.grid.count());
  EXPECT_EQ(outside + shared_part(whole.grid, part.grid).count(), part.grid.count());
}

TEST(Cut, gives_the_cells_of_a_window_and_nothing_beyond_any_edge) {
  const Raster whole = test::random_raster(grid, 1), part = cut(whole, {1, 2, 3, 1});
  EXPECT_EQ(part.grid.west, 500002.5);
  EXPECT_EQ(part.grid.south, 5400005);
  EXPECT_EQ(part.values, (std::vector<double>{whole.at(1, 2), whole.at(2, 2), whole.at(3, 2)}));
  for (const CellWindow& w :
       {CellWindow{-2, -1, 9, 7}, {3, 1, 6, 2}, {-3, 2, 5, 6}, {7, 7, 2, 2}, {-4, -4, 2, 2}, {0, 0, 5, 4}})
    expect_same_places(cut(whole, w), whole);
}

TEST(Cut, to_a_grid_takes_that_grids_own_corner_and_knows_one_lattice_from_another) {
  const Raster whole = test::random_raster(grid, 3);
  const MapGrid wanted{4, 6, 500005.0001, 5399994.9999, 2.5, ""};  // 4e-5 of a cell off
  ASSERT_TRUE(same_lattice(grid, wanted));
  const Raster part = cut_to(whole, wanted);
  EXPECT_EQ(part.grid.west, wanted.west);
  EXPECT_EQ(part.grid.south, wanted.south);
  expect_same_places(part, whole);
  EXPECT_TRUE(test::identical(resample_elevation(whole, wanted), part)) << "resampling on one lattice is a cut";
  EXPECT_TRUE(same_lattice(grid, {900, 700, 400000, 5300000, 2.5, ""}));
  EXPECT_FALSE(same_lattice(grid, {5, 4, 500001, 5400000, 2.5, ""})) << "0.4 of a cell off";
  EXPECT_FALSE(same_lattice(grid, {5, 4, 500000, 5400000, 5, ""}));
  EXPECT_FALSE(same_lattice(grid, {5000, 4, 500000, 5400000, 2.5 * (1 + 1e-7), ""}))
      << "off by 5e-4 of a cell at the far end";
}

TEST(Cut, shared_part_is_what_both_grids_hold) {
  const MapGrid other{5, 4, 500005, 5399997.5, 2.5, ""}, shared = shared_part(grid, other);
  EXPECT_EQ(shared.west, 500005);
  EXPECT_EQ(shared.south, 5400000);
  EXPECT_EQ(shared.columns, 3);
  EXPECT_EQ(shared.rows, 3);
  const MapGrid back = shared_part(other, grid);
  EXPECT_EQ(back.count(), shared.count());
  EXPECT_EQ(shared_part(grid, {5, 4, 600000, 5400000, 2.5, ""}).count(), 0U) << "apart";
  EXPECT_EQ(shared_part(grid, {5, 4, 500012.5, 5400000, 2.5, ""}).count(), 0U) << "side by side";
}

TEST(Polygon, knows_how_far_its_edge_is_and_on_which_side) {
  // A square of 10 m with a hole of 2 m in its middle.
  const MapPolygon square{
      .rings = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{4, 4}, {4, 6}, {6, 6}, {6, 4}}}, .numbers = {}, .name = {}};
  EXPECT_DOUBLE_EQ(signed_distance(square, 2, 5), -2);
  EXPECT_DOUBLE_EQ(signed_distance(square, 5, 5), 1) << "in the hole";
  EXPECT_DOUBLE_EQ(signed_distance(square, 13, 14), 5) << "from the corner";
  EXPECT_DOUBLE_EQ(signed_distance(square, 5, -0.5), 0.5);
}

MapGrid square_grid(int cells) {
  return {.columns = cells, .rows = cells, .west = 100, .south = 200, .cell = 1, .crs_wkt = ""};
}

TEST(cells_inside, counts_cells_whose_centre_lies_in_a_ring_on_the_grid_and_not_in_its_hole) {
  const MapPolygon square{
      {{{101, 201}, {105, 201}, {105, 205}, {101, 205}}, {{102, 202}, {102, 204}, {104, 204}, {104, 202}}}, {}, ""};
  const auto inside = cells_inside({square}, square_grid(8));
  EXPECT_EQ(std::count(inside.begin(), inside.end(), 1), 16 - 4);
  EXPECT_EQ(inside[square_grid(8).index(1, 1)], 1);
  EXPECT_EQ(inside[square_grid(8).index(2, 2)], 0);
  EXPECT_EQ(inside[square_grid(8).index(0, 1)], 0);
  const MapPolygon wide{{{{0, 203}, {1000, 203}, {1000, 205}, {0, 205}}}, {}, ""};
  const auto within = cells_inside({wide}, square_grid(8));
  EXPECT_EQ(std::count(within.begin(), within.end(), 1), 16);
  EXPECT_EQ(within[square_grid(8).index(7, 4)], 1);
}

TEST(Places, come_back_to_a_centimetre_and_those_that_are_none_are_refused) {
  const MapPlace gauge{"gauge bridge; south", {{{500050.126, 5000100}}}};
  const MapPlace wall{"obstacle \"wall\"", {{{0, 0}, {4, 0}, {4, 100.5}}, {{-1, -1}, {-2, -1}, {-1, -2}}}};
  const auto places = places_in(places_json({gauge, wall}));
  ASSERT_TRUE(places);
  ASSERT_EQ(places->size(), 2U);
  EXPECT_EQ(places->at(0).words, gauge.words);
  EXPECT_EQ(places->at(0).rings.at(0).at(0)[0], 500050.13);
  EXPECT_EQ(places->at(1), wall);
  const auto ring = [](const std::string& text) { return R"([{"words": "gauge a", "rings": [)" + text + "]}]"; };
  EXPECT_TRUE(places_in(ring("[[1, 2]]")));
  for (const std::string& text : {std::string(), std::string("{}"), std::string("[{}]"), ring("[]"), ring("[[1]]"),
                                  ring("[[1, null]]"), ring("[[1, \"2\"]]"), ring("[[1, 1e999]]"), ring("1")})
    EXPECT_FALSE(places_in(text)) << text;
}

TEST(Statistics, takes_quantiles_between_the_sorted_values_and_percentiles_of_what_is_above_0) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2, 5}, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({10, 0}, 0.05), 0.5);
  EXPECT_DOUBLE_EQ(quantile({7, 8, 9}, 1), 9);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)) && std::isnan(median({})));
  EXPECT_EQ(median({1, 2, 4, 9}), 3);
  std::vector<double> map(1000, 0.0);
  map[3] = std::nan("");
  for (int n = 1; n <= 101; ++n) map[static_cast<std::size_t>(5 * n)] = n;
  EXPECT_DOUBLE_EQ(p99_of_positive(map), 100) << "cells without anything do not count";
  EXPECT_TRUE(std::isnan(p99_of_positive({0, 0, std::nan("")})));
}

TEST(Statistics, nmad_does_not_see_an_outlier) {
  EXPECT_DOUBLE_EQ(nmad({1, 2, 3, 4, 1000}), 1.4826) << "median 3, distances 2 1 0 1 997";
  EXPECT_TRUE(std::isnan(nmad({})));
  std::mt19937 random(1);
  std::normal_distribution<double> normal(3, 2);
  std::vector<double> values;
  for (int i = 0; i < 20001; ++i) values.push_back(i % 10 == 0 ? 1e6 : normal(random));
  EXPECT_NEAR(median(values), 3, 0.4);  // a tenth on one side moves the middle by 0.14 standard deviations
  EXPECT_NEAR(nmad(values), 2, 0.4);
}

TEST(Statistics, spread_leaves_out_draws_without_a_value_and_half_of_the_volume_is_thicker_than_the_median) {
  const auto spread = spread_of({1, std::nan(""), 3});
  EXPECT_DOUBLE_EQ(spread.mean, 2);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(spread.low, 1.1);
  EXPECT_DOUBLE_EQ(spread.high, 2.9);
  EXPECT_EQ(spread_of({5}).deviation, 0);
  EXPECT_TRUE(std::isnan(spread_of({}).mean));
  const MapGrid ten{10, 10, 0, 0, 20, ""};
  Raster rim{ten, std::vector<double>(ten.count(), 1.0)};  // half of the columns, a tenth of the volume
  for (std::size_t n = 0; n < rim.values.size() / 2; ++n) rim.values[n] = 9;
  EXPECT_EQ(median_thickness(rim), 9.0);
  for (double& t : rim.values) t = 0;
  EXPECT_EQ(median_thickness(rim), 0);
}

/// Frank Slide, 36 million m3: H/L of 0.28 (Scheidegger) and 0.20 (Corominas); about 0.25 was observed.
TEST(UsualReach, holds_the_published_regressions_and_is_bounded_by_those_that_hold_for_a_volume) {
  const auto regressions = reach_regressions();
  ASSERT_EQ(regressions.size(), 2u);
  EXPECT_NEAR(regressions[0].tangent(36e6), 0.2757, 1e-3);
  EXPECT_NEAR(regressions[1].tangent(36e6), 0.2045, 1e-3);
  EXPECT_NEAR(regressions[1].tangent(1e6), 0.2773, 1e-3);  // 10^(-0.047 - 0.51)
  const ReachBounds large = usual_reach(36e6), small = usual_reach(5e4), none = usual_reach(10);
  EXPECT_NEAR(large.low, 0.2045 / 2, 1e-3);
  EXPECT_NEAR(large.high, 0.2757 * 2, 1e-3);
  EXPECT_NEAR(small.high / small.low, 4, 1e-9);  // one regression alone
  EXPECT_EQ(none.high, 0);
}

const MapGrid field_grid{.columns = 50, .rows = 37, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};

/// Mean product of cells (dx, dy) apart, over many fields: the covariance, because the mean is 0 by construction.
double covariance(double range, int dx, int dy) {
  RandomField field(field_grid, range, 7);
  double sum = 0, count = 0;
  for (int draw = 0; draw < 400; ++draw) {
    const auto v = field.next();
    for (int row = 0; row + dy < field_grid.rows; ++row)
      for (int column = 0; column + dx < field_grid.columns; ++column) {
        sum += v[field_grid.index(column, row)] * v[field_grid.index(column + dx, row + dy)];
        ++count;
      }
  }
  return sum / count;
}

// 400 fields of about 1850 / (8 x 8) independent patches: a standard error near 0.01 for the variance; 0.04 is four of
// them.
constexpr double chance = 0.04;

TEST(RandomField, has_unit_variance_and_spherical_correlation_or_none_without_a_range) {
  EXPECT_NEAR(covariance(80, 0, 0), 1, chance);
  EXPECT_NEAR(covariance(80, 4, 0), 1 - 1.5 * 0.5 + 0.5 * 0.125, chance) << "half the range: 0.3125";
  EXPECT_NEAR(covariance(80, 0, 4), 0.3125, chance) << "the same northwards";
  EXPECT_NEAR(covariance(80, 3, 4), 1 - 1.5 * 0.625 + 0.5 * std::pow(0.625, 3), chance) << "and askew: five cells";
  EXPECT_NEAR(covariance(80, 8, 0), 0, chance) << "nothing is left at the range";
  EXPECT_NEAR(covariance(80, 48, 0), 0, chance) << "opposite edges do not know each other";
  EXPECT_NEAR(covariance(0, 0, 0), 1, 0.01);  // 740 000 independent values: a standard error of 0.0016
  EXPECT_NEAR(covariance(0, 1, 0), 0, 0.01);
}

TEST(RandomField, is_the_same_for_the_same_seed_and_never_twice_in_a_row) {
  RandomField one(field_grid, 80, 5), same(field_grid, 80, 5), other(field_grid, 80, 6);
  const auto first = one.next(), second = one.next(), third = one.next();
  EXPECT_EQ(first, same.next());
  EXPECT_EQ(second, same.next());
  EXPECT_EQ(third, same.next());
  EXPECT_NE(first, other.next());
  EXPECT_NE(first, second);
  EXPECT_NE(first, third);
  other.start(5);
  EXPECT_EQ(other.next(), first) << "a series that is begun again";
  EXPECT_EQ(other.next(), second);
}

TEST(RandomField, takes_ranges_far_beyond_the_map) {
  RandomField field({.columns = 8, .rows = 8, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""}, 1e9, 1);
  const auto v = field.next();
  for (const double value : v) EXPECT_NEAR(value, v[0], 3) << "nearly one value: the range counts as 24 cells";
}

TEST(fourier_length, has_no_prime_factor_beyond_five) {
  EXPECT_EQ(fourier_length(1), 1);
  EXPECT_EQ(fourier_length(7), 8);
  EXPECT_EQ(fourier_length(97), 100);
  EXPECT_EQ(fourier_length(2032), 2048);
}

TEST(fourier_transform, finds_one_wave_at_its_place_and_gives_it_back) {
  constexpr int wide = 12, high = 10, along_x = 3, along_y = 8;
  std::vector<std::complex<double>> plane;
  for (int row = 0; row < high; ++row)
    for (int column = 0; column < wide; ++column)
      plane.push_back(
          std::polar(2.0, 2 * std::numbers::pi * (column * double(along_x) / wide + row * double(along_y) / high)));
  const auto wave = plane;
  fourier_transform(plane, wide, high);
  for (std::size_t i = 0; i < plane.size(); ++i)
    EXPECT_NEAR(std::abs(plane[i] - (i == along_y * wide + along_x ? 2.0 * wide * high : 0.0)), 0, 1e-11) << i;
  inverse_fourier_transform(plane, wide, high);
  for (std::size_t i = 0; i < plane.size(); ++i) EXPECT_NEAR(std::abs(plane[i] - wave[i]), 0, 1e-13);
}

}  // namespace
}  // namespace talus
