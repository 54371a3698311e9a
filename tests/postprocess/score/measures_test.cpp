// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <cmath>

#include <fmt/format.h>

#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "postprocess/score/contingency.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/score/thalweg.hpp"
#include "tests/common/geojson.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::block;
using test::holds;
using test::small_grid;
using test::small_run;

TEST(Contingency, counts_areas_on_a_mask_made_by_hand) {
  //                               TP FP FN TN TN  not compared
  const std::vector<double> simulated{2, 3, 0, 0, 1, nan, 5};
  const std::vector<double> surveyed{2, 0, 4, 0, 1, 7, nan};
  const auto c = compare(simulated, 1, surveyed, 1, 25);  // a value equal to the threshold is no
  EXPECT_EQ(c.true_positive, 25);
  EXPECT_EQ(c.false_positive, 25);
  EXPECT_EQ(c.false_negative, 25);
  EXPECT_EQ(c.true_negative, 50);
  EXPECT_DOUBLE_EQ(c.csi(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(c.hit_rate(), 0.5);
  EXPECT_DOUBLE_EQ(c.false_alarm_ratio(), 0.5);
  EXPECT_DOUBLE_EQ(c.foc(), 1.0);
  EXPECT_DOUBLE_EQ(c.hss(), 2.0 * (1 * 2 - 1) / ((2 * 3) + (2 * 3)));
  EXPECT_DOUBLE_EQ(c.d2pc(), std::hypot(0.5, 1.0 / 3));
}

TEST(Contingency, is_perfect_for_equal_maps_undefined_for_empty_ones_and_takes_a_threshold_for_each_side) {
  const std::vector<double> map{0, 3, 5, 0};
  EXPECT_EQ(compare(map, 1, map, 1, 1).csi(), 1);
  EXPECT_EQ(compare(map, 1, map, 1, 1).hss(), 1);
  EXPECT_EQ(compare(map, 1, map, 1, 1).d2pc(), 0);
  const std::vector<double> nothing(4, 0.0);
  EXPECT_TRUE(std::isnan(compare(nothing, 1, nothing, 1, 1).csi()));
  // A polygon's inside (1) against a thickness.
  EXPECT_EQ(compare({2, 0.8}, 1, {1, 1}, 0.5, 1).true_positive, 1);
  EXPECT_EQ(compare({2, 0.8}, 1, {1, 1}, 0.5, 1).false_negative, 1);
}

TEST(Contingency, makes_a_synthetic_index_of_five_parts) {
  Contingency c;
  c.true_positive = 60, c.false_positive = 20, c.false_negative = 40, c.true_negative = 123456;  // TN has no part in it
  const double csi = 60.0 / 120, tn = 5 * 100 - 20;
  const double hss = 2 * (60 * tn - 20 * 40) / (100 * (40 + tn) + 80 * (20 + tn));
  const double d2pc = std::hypot(0.4, 20.0 / 500);
  const double foc = std::pow(std::sin(1.5707963267948966 * 0.8), 5),
               reach = std::pow(std::sin(1.5707963267948966 * 0.9), 5);
  EXPECT_DOUBLE_EQ(c.spi(0.9), (csi + hss + 1 - d2pc + foc + reach) / 5);
  EXPECT_DOUBLE_EQ(c.spi(0.9), c.spi(1 / 0.9)) << "too far counts as too short by the same ratio";
  EXPECT_TRUE(std::isnan(c.spi(nan)));
  EXPECT_TRUE(std::isnan(Contingency{}.spi(1)));
  const std::vector<double> map{0, 3, 5, 0};
  EXPECT_DOUBLE_EQ(compare(map, 1, map, 1, 1).spi(1), 1);
  EXPECT_NEAR(compare({0, 0, 0, 0}, 1, map, 1, 1).spi(1e-9), 0, 1e-12) << "nothing right is 0, not below";
}

TEST(ThicknessError, is_taken_over_the_union_of_both_deposits) {
  //                               both  sim  survey  neither  not surveyed
  const std::vector<double> simulated{4, 3, 0, 0.5, 9};
  const std::vector<double> surveyed{2, 0, 6, 0.9, nan};
  const auto error = thickness_error(simulated, surveyed, 1);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((4.0 + 9 + 36) / 3));
  EXPECT_DOUBLE_EQ(error.bias, (2.0 + 3 - 6) / 3);
  EXPECT_DOUBLE_EQ(error.mean_absolute, 11.0 / 3);
  EXPECT_DOUBLE_EQ(error.median, 2) << "of 2, 3 and -6";
  EXPECT_DOUBLE_EQ(error.nmad, 1.4826) << "distances from it 0, 1 and 8";
  EXPECT_TRUE(std::isnan(thickness_error({0}, {0}, 1).rmse));
  EXPECT_TRUE(std::isnan(thickness_error({0}, {0}, 1).nmad));
}

TEST(Auroc, counts_pairs_and_halves_ties_from_perfect_order_to_none) {
  // Survey yes at 5, 2, 0; no at 3, 0, 0. Pairs won: 5 beats all three; 2 beats two; 0 ties with two: (3 + 2 + 1) / 9.
  EXPECT_DOUBLE_EQ(auroc({5, 2, 0, 3, 0, 0, 9, nan}, {4, 4, 4, 0, 1, 0, nan, 4}, 1), 6.0 / 9);
  EXPECT_EQ(auroc({4, 3, 2, 1}, {9, 9, 0, 0}, 1), 1);
  EXPECT_EQ(auroc({1, 2, 3, 4}, {9, 9, 0, 0}, 1), 0);
  EXPECT_EQ(auroc({1, 1, 1, 1}, {9, 9, 0, 0}, 1), 0.5);
  EXPECT_TRUE(std::isnan(auroc({1, 2}, {9, 9}, 1)));
}

TEST(BrierScore, is_the_mean_square_of_share_less_survey) {
  EXPECT_DOUBLE_EQ(brier_score({0.5, 0, 1, 0, nan}, {2, 2, 0, 0, 2}, 1), (0.25 + 1 + 1) / 3);
  EXPECT_EQ(brier_score({1, 0}, {2, 1}, 1), 0);
  EXPECT_TRUE(std::isnan(brier_score({0}, {0}, 1)));
}

TEST(Residual, is_measured_in_units_of_sigma_and_has_no_value_without_a_cell) {
  //                                       r:  1    -2   0.5   no sigma  not surveyed  not counted
  const auto r = residual_of({3, 1, 2.5, 9, 9, 9}, {2, 2, 2, 1, nan, 1}, {1, 0.5, 1, 0, 1, 1}, {1, 1, 1, 1, 1, 0});
  EXPECT_EQ(r.cells, 3u);
  EXPECT_DOUBLE_EQ(r.median, 0.5);
  EXPECT_DOUBLE_EQ(r.within, 2.0 / 3);
  EXPECT_DOUBLE_EQ(r.chi_squared, (1 + 4 + 0.25) / 3);
  const auto none = residual_of({3}, {2}, {1}, {0});
  EXPECT_EQ(none.cells, 0u);
  EXPECT_TRUE(std::isnan(none.chi_squared));
}

TEST(Polyline, is_walked_in_even_steps_and_loses_its_corners_but_not_its_ends_when_smoothed) {
  const Polyline bend{{0, 0}, {30, 0}, {30, 40}};
  EXPECT_EQ(lengths_along(bend), (std::vector<double>{0, 30, 70}));
  const auto even = resampled(bend, 10.4);  // 70 m: seven steps of 10 m come nearest
  ASSERT_EQ(even.size(), 8u);
  EXPECT_EQ(even[3], (std::array<double, 2>{30, 0}));
  EXPECT_EQ(even[5], (std::array<double, 2>{30, 20}));
  EXPECT_EQ(even.back(), bend.back());
  const Polyline corner{{0, 0}, {10, 0}, {10, 10}};
  const auto once = smoothed(corner, 1);
  EXPECT_EQ(once.front(), corner.front());
  EXPECT_EQ(once.back(), corner.back());
  EXPECT_EQ(once[1], (std::array<double, 2>{7.5, 2.5}));
}

TEST(Polyline, drops_what_goes_back_on_itself) {
  const Polyline restless{{0, 0}, {10, 0}, {11, 0}, {20, 1}, {14, 3}, {30, 2}, {28, 2}};
  const auto straight = without_returns(restless, 5);
  EXPECT_EQ(straight, (Polyline{{0, 0}, {10, 0}, {20, 1}, {28, 2}})) << "near points and returns go, the last stays";
  EXPECT_EQ(without_returns({{3, 4}}, 5).size(), 1u);
}

const MapGrid grid{.columns = 5, .rows = 5, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};

TEST(FlowPath, stays_in_the_flow_round_a_bend) {
  // Down the western column, then along the southern row: the straight way would cross dry ground.
  std::vector<double> thickness(grid.count(), 0.0);
  for (int k = 0; k < 5; ++k) thickness[grid.index(0, k)] = thickness[grid.index(k, 0)] = 2;
  const auto path = flow_path(grid, thickness, {5, 45}, {45, 5});
  EXPECT_EQ(path.front(), (std::array<double, 2>{5, 45}));
  EXPECT_EQ(path.back(), (std::array<double, 2>{45, 5}));
  for (const auto& [x, y] : path) EXPECT_TRUE(x == 5 || y == 5) << x << ' ' << y;
}

TEST(FlowPath, keeps_to_the_thickest_and_is_straight_to_a_place_beyond_the_grid) {
  std::vector<double> thickness(grid.count(), 1.0);
  for (int column = 0; column < 5; ++column) thickness[grid.index(column, 3)] = 9;
  const auto path = flow_path(grid, thickness, {5, 25}, {45, 25});
  EXPECT_EQ(path[path.size() / 2][1], 35) << "a detour of a row through nine times the thickness";
  const std::vector<double> even(grid.count(), 1.0);
  EXPECT_EQ(flow_path(grid, even, {5, 5}, {500, 5}).size(), 2u);
  EXPECT_EQ(flow_path(grid, even, {5, 5}, {6, 6}).size(), 2u);
}

/// small_run() against its own deposit, known to `sigma` where something was measured.
struct Setting {
  talus::Run run = test::small_run();
  Options options;
  Survey survey;
  Thalweg thalweg;

  explicit Setting(double sigma, double range = 0) {
    survey.name = "made by hand";
    survey.grid = small_grid();
    survey.measured = survey.deposit = run.maps.deposit_thickness;
    survey.error = {std::vector<double>(survey.grid.count(), sigma), range, 1.96};
    options.deposit_threshold = 0.5;
    options.survey.resamples = 400;
    thalweg = thalweg_of(run, options);
  }
  Resampled draw() const {
    Scored scored{run, options, &survey, thalweg, crown(run.maps, 1), 0};
    return resample(scored, bring_to_survey_grid(run.maps, survey, options));
  }
};

TEST(Resample, has_no_spread_without_an_error_and_is_the_same_each_time) {
  const auto all = Setting(0).draw();
  ASSERT_EQ(all.deposit_csi.size(), 400u);
  EXPECT_EQ(spread_of(all.deposit_csi).low, 1);
  EXPECT_EQ(spread_of(all.rmse).high, 0);
  EXPECT_EQ(spread_of(all.volume).deviation, 0);
  EXPECT_EQ(spread_of(all.runout_difference).high, 0);
  EXPECT_TRUE(all.footprint_csi.empty()) << "a thickness says nothing of the footprint";
  auto setting = Setting(0.7, 30);
  EXPECT_EQ(setting.draw().deposit_csi, setting.draw().deposit_csi);
}

TEST(Resample, carries_the_error_into_volume_bias_and_rmse) {
  // 100 cells of 100 m2, at 1.5 m or more, off by 0.2 m each for itself: no cell falls under the threshold of 0.5 m.
  const auto all = Setting(0.2).draw();
  const double sigma_volume = 0.2 * 100 * std::sqrt(100.0);
  EXPECT_NEAR(spread_of(all.volume).deviation, sigma_volume,
              0.15 * sigma_volume);  // 400 draws: a standard error of 3.5 %
  EXPECT_NEAR(spread_of(all.volume).mean, 24000, 4 * sigma_volume / 20);
  EXPECT_NEAR(spread_of(all.bias).deviation, 0.2 / 10, 0.15 * 0.2 / 10);
  EXPECT_NEAR(spread_of(all.rmse).mean, 0.2, 0.01);
  EXPECT_EQ(spread_of(all.deposit_csi).low, 1);
}

TEST(Resample, spreads_the_volume_more_where_errors_are_alike) {
  // Spherical correlation of range 1 km over a deposit of 100 m: all cells go together, up to a few per cent.
  const auto alike = spread_of(Setting(0.2, 1000).draw().volume);
  EXPECT_NEAR(alike.deviation, 0.2 * 100 * 100, 0.25 * 0.2 * 100 * 100) << "mean correlation about 0.92, 400 draws";
}

TEST(Resample, lowers_the_agreement_where_the_deposit_is_hardly_above_the_error) {
  auto setting = Setting(0.7, 30);  // 1.5 m of deposit, a level of detection of 1.37 m
  const auto csi = spread_of(setting.draw().deposit_csi);
  EXPECT_LT(csi.high, 1);
  EXPECT_GT(csi.low, 0.3);
  EXPECT_GT(csi.deviation, 0.01);
  setting.survey.error.detection = 0;
  EXPECT_GT(spread_of(setting.draw().deposit_csi).mean, csi.mean) << "without a level of detection less is lost";
}

TEST(Resample, takes_no_noise_far_away_for_run_out) {
  // Ground measured as 0.01 m everywhere, so that it is drawn too: some of it rises above the threshold in every draw.
  auto setting = Setting(0.7);
  setting.survey.error.detection = 0;
  for (double& v : setting.survey.measured) v = v == 0 ? 0.01 : v;
  const auto all = setting.draw();
  EXPECT_LT(spread_of(all.deposit_csi).high, 0.5) << "a fifth of the dry ground is above 0.5 m now";
  setting.survey.error.sigma.assign(setting.survey.grid.count(), 0.2);
  const auto quiet = setting.draw();
  // 0.7 % of the ground is above the threshold; the eastern edge is 50 m beyond the deposit's.
  EXPECT_GE(spread_of(quiet.runout_difference).low, -25) << "a cell or two where noise touches the deposit";
  EXPECT_LT(spread_of(quiet.deposit_csi).mean, 1);
}

TEST(Patches, keeps_those_that_hold_a_seed) {
  const MapGrid grid{.columns = 4, .rows = 3, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  const std::vector<double> values{5, 0, 0,   4,  //
                                   0, 5, 0,   4,  //
                                   0, 0, 0.5, 0};
  std::vector<char> seeds(12, 0);
  seeds[0] = seeds[2] = 1;                      // the second on a cell below the threshold: no patch
  const std::vector<double> kept{5, 0, 0,   0,  //
                                 0, 5, 0,   0,  //
                                 0, 0, 0.5, 0};
  EXPECT_EQ(patches_with(grid, values, 1, seeds), kept) << "corners join, values below the threshold stay as they are";
}

/// small_run() with its mass at columns [first, first + 4) of the release's rows at every time.
talus::Run run_with_frames(const std::vector<int>& first) {
  auto run = small_run();
  run.frames = {};
  for (std::size_t k = 0; k < first.size(); ++k) {
    run.frames.time.push_back(5.0 * static_cast<double>(k));
    run.frames.thickness.push_back(block(run.maps.grid, first[k], first[k] + 4, 10, 20, 6.0));
  }
  return run;
}

Thalweg line_of(const std::vector<std::array<double, 2>>& points) {
  Thalweg thalweg{.line = points, .distance = {0}, .given = false, .origin = ""};
  for (std::size_t i = 1; i < points.size(); ++i)
    thalweg.distance.push_back(thalweg.distance.back() +
                               std::hypot(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]));
  return thalweg;
}

TEST(Thalweg, follows_the_centre_of_mass_from_the_crown_to_the_farthest_deposit) {
  const auto run = run_with_frames({3, 8, 14, 20, 26, 27, 26});
  const auto thalweg = thalweg_of(run, {});
  ASSERT_GT(thalweg.line.size(), 10u);
  EXPECT_FALSE(thalweg.given);
  EXPECT_EQ(thalweg.origin, "path of the centre of mass");
  const auto& grid = run.maps.grid;
  EXPECT_EQ(thalweg.line.front()[0], grid.x(3)) << "the crown is in the release's westernmost column";
  EXPECT_EQ(thalweg.line.back()[0], grid.x(34)) << "the last column of the deposit";
  for (std::size_t i = 1; i < thalweg.line.size(); ++i) {
    EXPECT_GT(thalweg.line[i][0], thalweg.line[i - 1][0]) << "never back, though the mass sways at the end";
    EXPECT_NEAR(thalweg.distance[i] - thalweg.distance[i - 1], grid.cell, 0.1 * grid.cell);
  }
  const double middle = thalweg.line[thalweg.line.size() / 2][1];
  EXPECT_NEAR(middle, grid.south + 150, 0.5 * grid.cell) << "mid-stream: rows 10 to 19";
}

TEST(Thalweg, takes_the_way_through_the_flow_where_the_mass_hardly_moves_and_is_empty_without_a_deposit) {
  const auto run = run_with_frames({3, 4});
  const auto thalweg = thalweg_of(run, {});
  EXPECT_TRUE(holds(thalweg.origin, {"moves less than five cells"}));
  EXPECT_EQ(thalweg.line.front()[0], run.maps.grid.x(3));
  EXPECT_EQ(thalweg.line.back()[0], run.maps.grid.x(34));
  auto dry = small_run();
  dry.maps.deposit_thickness.assign(dry.maps.grid.count(), 0.0);
  const auto none = thalweg_of(dry, {});
  EXPECT_TRUE(none.line.empty());
  EXPECT_EQ(none.length(), 0);
  EXPECT_EQ(none.origin, "no deposit above the threshold");
}

TEST(Thalweg, reaches_as_far_as_the_longer_of_run_and_survey) {
  const auto run = run_with_frames({3, 8, 14, 20, 26, 27, 26});
  const auto& grid = run.maps.grid;
  Survey survey;
  survey.grid = grid;
  const auto end_of = [&](const Options& options) { return thalweg_of(run, options, survey).line.back(); };
  for (const int columns : {20, 34}) {
    survey.deposit = block(grid, columns - 2, columns, 10, 20, 2.0);
    EXPECT_EQ(end_of({})[0], grid.x(34)) << "the run goes farther";
  }
  survey.deposit = block(grid, 37, 39, 20, 22, 0.5);
  EXPECT_EQ(end_of({})[0], grid.x(38));
  EXPECT_EQ(end_of({})[1], grid.y(21));
  survey.deposit.clear();
  survey.footprint = block(grid, 37, 40, 14, 16, 1.0);  // an outline
  survey.footprint_threshold = 0.5;
  EXPECT_EQ(end_of({})[0], grid.x(39));
}

TEST(Thalweg, of_a_line_that_is_given_is_carried_on_without_moving_a_place_along_it) {
  const test::Scratch scratch;
  Options options;
  options.thalweg = scratch.write(
      "line.geojson", test::geojson(test::feature("LineString", "[[600010,5100150],[600210,5100150]]"), 32632));
  const auto run = small_run();
  const auto thalweg = thalweg_of(run, options);
  EXPECT_NEAR(thalweg.length(), 345 - 10, 1e-6) << "to the centre of column 34";
  EXPECT_NEAR(project(thalweg, 600300, 5100150).distance, 290, 1e-6);
  Survey survey;
  survey.grid = run.maps.grid;
  survey.deposit = block(survey.grid, 39, 40, 14, 16, 1.0);
  EXPECT_NEAR(thalweg_of(run, options, survey).length(), 395 - 10, 1e-6);
}

TEST(Thalweg, turns_a_given_line_so_that_it_begins_at_the_higher_end) {
  const test::Scratch scratch;
  Options options;
  options.thalweg = scratch.write(
      "line.geojson",
      test::geojson(test::feature("LineString", "[[600390,5100150],[600200,5100150],[600010,5100150]]"), 32632));
  const auto thalweg = thalweg_of(small_run(), options);
  EXPECT_TRUE(thalweg.given);
  EXPECT_EQ(thalweg.line.front()[0], 600010) << "the slope falls to the east";
  EXPECT_DOUBLE_EQ(thalweg.length(), 380);
  EXPECT_EQ(thalweg.line.size(), 39u) << "a vertex a cell";
}

TEST(Thalweg, refuses_what_is_not_one_line_over_the_run) {
  const test::Scratch scratch;
  Options options;
  const auto fault = [&](const std::string& text) {
    options.thalweg = scratch.write("line.geojson", text);
    return test::fault_of<DataError>([&] { thalweg_of(small_run(), options); });
  };
  EXPECT_TRUE(holds(fault(test::geojson(test::feature("LineString", "[[500000,5100150],[500100,5100150]]"), 32632)),
                    {"misses the run's area"}));
  EXPECT_TRUE(holds(
      fault(test::geojson(
          test::feature("MultiLineString", "[[[600010,5100150],[600100,5100150]],[[600200,5100150],[600300,5100150]]]"),
          32632)),
      {"2 lines (a thalweg is one line)"}));
  EXPECT_TRUE(holds(fault(test::geojson(test::feature("Point", "[600010,5100150]"), 32632)),
                    {"no line in layer \"line\" (it holds POINT)"}));
}

TEST(Thalweg, samples_a_map_bilinearly_and_measures_along_itself_and_beyond_its_ends) {
  const MapGrid grid{.columns = 3, .rows = 2, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  const std::vector<double> values{0, 10, 20, 100, 110, 120};
  const auto samples = sample_along(line_of({{5, 5}, {10, 10}, {25, 15}, {500, 5}}), grid, values);
  EXPECT_DOUBLE_EQ(samples[0], 0);
  EXPECT_DOUBLE_EQ(samples[1], 55);
  EXPECT_DOUBLE_EQ(samples[2], 120);
  EXPECT_TRUE(std::isnan(samples[3]));
  const auto thalweg = line_of({{0, 0}, {30, 0}, {30, 40}});
  EXPECT_DOUBLE_EQ(project(thalweg, 10, 5).distance, 10);
  EXPECT_DOUBLE_EQ(project(thalweg, 10, 5).offset, 5) << "left of the way down";
  EXPECT_DOUBLE_EQ(project(thalweg, 34, 20).distance, 50);
  EXPECT_DOUBLE_EQ(project(thalweg, 34, 20).offset, -4);
  EXPECT_DOUBLE_EQ(project(thalweg, 30, 55).distance, 85);
  EXPECT_DOUBLE_EQ(project(thalweg, -7, 1).distance, -7);
}

TEST(Thalweg, follows_the_front_by_the_times_of_arrival) {
  auto run = run_with_frames({3, 8, 14});
  auto& maps = run.maps;
  const auto thalweg = line_of({{600000, 5100150}, {600400, 5100150}});
  maps.arrival_time.assign(maps.grid.count(), nan);
  const auto arrive = [&](int column, double time) { maps.arrival_time[maps.grid.index(column, 15)] = time; };
  EXPECT_TRUE(front_by_arrival(maps, thalweg, 1).time.empty()) << "nothing came anywhere";
  for (int column = 3; column < 7; ++column) arrive(column, 0);  // released
  arrive(7, 1.25);
  arrive(8, 2.5);
  arrive(2, 3);  // uphill: the front stays where it is
  arrive(9, 9.75);
  auto front = front_by_arrival(maps, thalweg, 1);
  EXPECT_EQ(front.time, (std::vector<double>{0, 1.25, 2.5, 9.75}));
  EXPECT_EQ(front.value, (std::vector<double>{65, 75, 85, 95}));
  front = front_by_arrival(maps, thalweg, 15);
  EXPECT_EQ(front.value, (std::vector<double>{65, 85, 95})) << "the last one is there whatever the step";
}

}  // namespace
}  // namespace talus::postprocess
