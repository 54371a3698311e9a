// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/compare/compare.hpp"
#include "postprocess/report/page.hpp"
#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

using test::holds;

TEST(CompareDeposits, of_a_run_with_itself_differ_by_nothing) {
  const talus::Run run = test::small_run();
  const DepositDifference same = deposit_difference(run.maps, run.maps, 0.5);
  EXPECT_EQ(same.moved, 0);
  EXPECT_EQ(same.overlap, 1);
  EXPECT_EQ(same.rms, 0);
  EXPECT_EQ(same.volume, 0);
  EXPECT_EQ(same.larger, 0);
  EXPECT_EQ(same.smaller, 0);
}

/// Cells of 2 and 1 m on a bar of 10 x 1 cells of 10 m: shifted by a cell, a tenth of ten lies elsewhere.
TEST(CompareDeposits, shifted_by_a_cell_are_measured) {
  RunMaps first;
  first.grid = {.columns = 12, .rows = 3, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  first.deposit_thickness.assign(first.grid.count(), 0);
  RunMaps second = first;
  for (int column = 0; column < 10; ++column) {
    first.deposit_thickness[first.grid.index(column, 1)] = 2;
    second.deposit_thickness[first.grid.index(column + 1, 1)] = 2;
  }
  const DepositDifference found = deposit_difference(first, second, 0.5);
  EXPECT_DOUBLE_EQ(found.moved, 0.1);
  EXPECT_DOUBLE_EQ(found.overlap, 9.0 / 11);
  EXPECT_DOUBLE_EQ(found.larger, 2);
  EXPECT_DOUBLE_EQ(found.smaller, 2);
  EXPECT_DOUBLE_EQ(found.p99, 2) << "two of eleven cells";
  EXPECT_DOUBLE_EQ(found.volume, 0);
  EXPECT_DOUBLE_EQ(found.rms, std::sqrt(8.0 / 11));
  EXPECT_EQ(found.difference.at(0, 1), -2);
  EXPECT_TRUE(std::isnan(found.difference.at(0, 0)));
}

/// Where 200 cells hold a deposit, the 99th percentile lies between the second and the third largest change.
TEST(CompareDeposits, have_a_99th_percentile_that_does_not_see_a_single_cell) {
  RunMaps first;
  first.grid = {.columns = 20, .rows = 11, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};
  first.deposit_thickness.assign(first.grid.count(), 0);
  for (int cell = 0; cell < 200; ++cell) first.deposit_thickness[static_cast<std::size_t>(cell)] = 2;
  RunMaps second = first;
  second.deposit_thickness[50] = 9;
  EXPECT_DOUBLE_EQ(deposit_difference(first, second, 0.5).larger, 7);
  EXPECT_DOUBLE_EQ(deposit_difference(first, second, 0.5).p99, 0);
  second.deposit_thickness[60] = second.deposit_thickness[70] = 1;
  EXPECT_NEAR(deposit_difference(first, second, 0.5).p99, 1, 1e-12) << "of either sign";
}

/// The same body on cells half as wide keeps its volume, and on the wide cells all of its shape.
TEST(CompareDeposits, of_other_cells_are_brought_to_the_first_grid_with_their_volume) {
  RunMaps coarse, fine;
  coarse.grid = {.columns = 4, .rows = 4, .west = 100, .south = 0, .cell = 10, .crs_wkt = ""};
  fine.grid = {.columns = 8, .rows = 8, .west = 100, .south = 0, .cell = 5, .crs_wkt = ""};
  coarse.deposit_thickness.assign(16, 0);
  fine.deposit_thickness.assign(64, 0);
  coarse.deposit_thickness[coarse.grid.index(1, 2)] = 4;
  for (int row = 4; row < 6; ++row)
    for (int column = 2; column < 4; ++column) fine.deposit_thickness[fine.grid.index(column, row)] = 5;
  const DepositDifference found = deposit_difference(coarse, fine, 0.5);
  EXPECT_DOUBLE_EQ(found.volume, 100);  // 1 m more on 100 m2
  EXPECT_DOUBLE_EQ(found.moved, 0);     // the same place
  EXPECT_DOUBLE_EQ(found.larger, 1);
}

TEST(CompareDeposits, have_classes_up_to_the_largest_difference) {
  DepositDifference found;
  found.larger = 3;
  found.smaller = 12;
  EXPECT_EQ(difference_limits(found), (std::vector<double>{0.2, 0.4, 1, 2, 4, 10}));
}

std::size_t count_of(const std::string& text, const std::string& words) {
  std::size_t count = 0;
  for (std::size_t at = text.find(words); at != std::string::npos; at = text.find(words, at + 1)) ++count;
  return count;
}

ComparedRun run_called(const std::string& name) {
  ComparedRun run{.name = name, .run = test::small_run(), .score = {}, .used = {}};
  run.run.history.columns = {{"time_s", "s", "", "", {0, 1, 2}}, {"kinetic_J", "J", "", "", {0, 5e6, 1e6}}};
  return run;
}

TEST(CompareCurves, show_every_record_of_both_runs_and_have_axes_of_few_round_steps) {
  const std::string page = history_charts(run_called("a <b>"), run_called("c"));
  EXPECT_EQ(count_of(page, "<polyline"), 2U);
  EXPECT_FALSE(holds(page, {"<b>"})) << "a name is no markup";
  const auto at = page.find("points=\"") + 8;
  const std::string points = page.substr(at, page.find('"', at) - at);
  EXPECT_EQ(std::count(points.begin(), points.end(), ','), 3);
  for (int n = 0; n < 66; ++n) {
    const double range = 1e-3 * std::pow(1.7, n);  // to 1e12
    EXPECT_GE(range / axis_step(range), 4 - 1e-9);
    EXPECT_LE(range / axis_step(range), 10 + 1e-9);
  }
}

TEST(CompareCurves, show_what_one_of_the_two_has_and_nothing_where_nothing_happened) {
  ComparedRun first = run_called("a"), second = run_called("b");
  second.run.history.columns.push_back({"gauge_toe_thickness_m", "m", "thickness", "gauge toe", {0, 1, 3}});
  second.run.history.columns.push_back({"gauge_far_thickness_m", "m", "thickness", "gauge far", {0, 0, 0}});
  const std::string page = history_charts(first, second);
  EXPECT_EQ(count_of(page, "<polyline"), 3U);
  EXPECT_TRUE(holds(page, {"gauge toe: thickness [m]"}));
  EXPECT_FALSE(holds(page, {"gauge far"}));
  first.run.history.columns.clear();
  second.run.history.columns.clear();
  EXPECT_EQ(history_charts(first, second), "");
}

TEST(ComparePage, lets_no_style_in_but_its_own_and_takes_names_as_text) {
  const std::string hostile = "<img src=x onerror=alert(1)>\"'";
  ComparedRun first{.name = hostile, .run = test::small_run(), .score = {}, .used = {}}, second = first;
  first.run.summary.title = hostile;
  for (double& h : second.run.maps.deposit_thickness) h *= 1.5;  // so that there are classes with colours
  const std::string page = comparison_html(first, second, 0.1);
  EXPECT_FALSE(holds(page, {"unsafe-"}));
  EXPECT_FALSE(holds(page, {"style=\""})) << "no browser that heeds the policy takes it";
  EXPECT_FALSE(holds(page, {"<img src=x"}));
  const std::size_t begin = page.find("<style>") + 7, end = page.find("</style>");
  ASSERT_LT(begin, end);
  const std::string style = page.substr(begin, end - begin);
  EXPECT_TRUE(
      holds(page, {"style-src " + policy_source(style) + "\"", "<rect width=\"100%\" height=\"100%\" fill=\"#"}));
}

}  // namespace
}  // namespace talus::postprocess
