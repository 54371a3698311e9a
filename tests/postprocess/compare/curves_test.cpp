// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Curves of a comparison: from all records, for what either run has.
#include "postprocess/compare/compare.hpp"

#include "tests/postprocess/scene.hpp"

namespace talus::postprocess {
namespace {

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

TEST(CompareCurves, show_every_record_of_both_runs) {
  const std::string page = history_charts(run_called("a <b>"), run_called("c"));
  EXPECT_EQ(count_of(page, "<polyline"), 2U);
  EXPECT_FALSE(test::holds(page, {"<b>"})) << "a name is no markup";
  const auto at = page.find("points=\"") + 8;
  const std::string points = page.substr(at, page.find('"', at) - at);
  EXPECT_EQ(std::count(points.begin(), points.end(), ','), 3);
}

TEST(CompareCurves, show_what_one_of_the_two_has_and_nothing_where_nothing_happened) {
  ComparedRun first = run_called("a"), second = run_called("b");
  second.run.history.columns.push_back({"gauge_toe_thickness_m", "m", "thickness", "gauge toe", {0, 1, 3}});
  second.run.history.columns.push_back({"gauge_far_thickness_m", "m", "thickness", "gauge far", {0, 0, 0}});
  const std::string page = history_charts(first, second);
  EXPECT_EQ(count_of(page, "<polyline"), 3U);
  EXPECT_TRUE(test::holds(page, {"gauge toe: thickness [m]"}));
  EXPECT_FALSE(test::holds(page, {"gauge far"}));
  first.run.history.columns.clear();
  second.run.history.columns.clear();
  EXPECT_EQ(history_charts(first, second), "");
}

TEST(CompareCurves, have_axes_of_few_round_steps) {
  for (int n = 0; n < 66; ++n) {
    const double range = 1e-3 * std::pow(1.7, n);  // to 1e12
    EXPECT_GE(range / axis_step(range), 4 - 1e-9);
    EXPECT_LE(range / axis_step(range), 10 + 1e-9);
  }
}

}  // namespace
}  // namespace talus::postprocess
