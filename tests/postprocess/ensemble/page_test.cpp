// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page of an ensemble is made of; the page itself is used in a browser by tests/pipeline.
#include <algorithm>
#include <numeric>

#include "postprocess/ensemble/budget_table.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"
#include "postprocess/ensemble/member_analysis.hpp"
#include "postprocess/ensemble/results.hpp"
#include "tests/common/ensemble/ensemble_scene.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"

namespace talus::postprocess {
namespace {

using test::holds;

struct Budget : testing::Test {
  Budget() {
    ensemble_.files = {"members.h5", "counts.h5"};
    ensemble_.table.design = "budget";
    add("recipe", "", 0);
  }

  /// A member whose deposit and footprint are those of the recipe, moved by whole columns to the east, times a factor.
  void add(const std::string& name, const std::string& row, int columns, double factor = 1) {
    RunMaps maps = test::member_maps(scene_, 14, 2), moved = maps;
    for (auto field : {&RunMaps::deposit_thickness, &RunMaps::peak_thickness})
      for (int r = 0; r < maps.grid.rows; ++r)
        for (int c = 0; c < maps.grid.columns; ++c)
          (moved.*field)[maps.grid.index(c, r)] =
              c < columns ? 0 : factor * (maps.*field)[maps.grid.index(c - columns, r)];
    add(name, row, std::move(moved));
  }
  void add(const std::string& name, const std::string& row, RunMaps maps) {
    ensemble_.table.names.push_back(name);
    ensemble_.table.rows.push_back(row);
    runs_.push_back(std::move(maps));
  }

  /// Counts of all members but one that failed and two that were left out, behind them.
  BudgetTable table() {
    MemberTable& members = ensemble_.table;
    const auto counted = static_cast<std::int64_t>(runs_.size());
    for (const char* row : {"modulus", "survey", "drag"}) {
      members.names.emplace_back(row);
      members.rows.emplace_back(row);
    }
    members.count = counted + 3;
    EnsembleCounts counts = empty_counts(scene_, members.count, {0, members.count}, {});
    counts.deposit_quantum = 1e-6;
    counts.other_cells = true;
    MemberResult result;
    result.run_out = 100;
    result.largest_speed = 10;
    result.p99_speed = 8;
    for (std::int64_t k = 0; k < counted; ++k) {
      counts.add(k, runs_[static_cast<std::size_t>(k)], result);
      result.run_out += 5;
      result.p99_speed += 0.5;
    }
    counts.fail(counted, "it flew, <apart>");
    counts.leave_out(counted + 1, "no survey");
    counts.leave_out(counted + 2, "");
    counts.changes = {{1, "something else\nsolve.a=1\nsolve.b=2"}};
    counts.add_finding(1, {.name = "dense-packing", .message = "packed fourfold"});
    ensemble_.counts = std::move(counts);
    rows_ = member_rows(ensemble_, options_, survey_);
    return budget_table(ensemble_, rows_, options_);
  }

  /// Half the sum of the differences over the volume, by hand.
  double elsewhere(std::size_t member) const {
    const std::vector<double>&own = runs_[0].deposit_thickness, &other = runs_[member].deposit_thickness;
    double moved = 0, ours = 0, theirs = 0;
    for (std::size_t i = 0; i < own.size(); ++i) {
      ours += own[i];
      theirs += other[i];
    }
    for (std::size_t i = 0; i < own.size(); ++i) moved += std::abs(own[i] - other[i] * ours / theirs);
    return 0.5 * moved / ours;
  }

  EnsembleScene scene_ = test::ensemble_scene();
  Ensemble ensemble_;
  Options options_;
  std::optional<Survey> survey_;
  std::vector<RunMaps> runs_;
  MemberRows rows_;
};

TEST_F(Budget, is_that_of_its_members_the_largest_first) {
  add("step", "step", 0, 2);
  add("friction-less", "friction", 1);
  add("cells", "cells", 3);
  const BudgetTable found = table();
  ASSERT_EQ(found.lines.size(), 5u) << "a row that has nothing to change is not told";
  const char* names[] = {"cells", "friction-less", "step", "modulus", "survey"};
  for (std::size_t n = 0; n < 5; ++n) EXPECT_EQ(found.lines[n].name, names[n]);
  EXPECT_NEAR(found.lines[0].elsewhere, elsewhere(3), 1e-6);
  EXPECT_NEAR(found.lines[1].elsewhere, elsewhere(2), 1e-6);
  EXPECT_NEAR(found.lines[2].elsewhere, 0, 1e-6) << "volumes are set equal";
  EXPECT_GT(found.lines[0].elsewhere, found.lines[1].elsewhere);
  EXPECT_NEAR(found.lines[2].volume, 2 * found.own.volume, 1e-5 * found.own.volume);
  EXPECT_EQ(found.lines[2].overlap, 1);
  EXPECT_LT(found.lines[0].overlap, found.lines[1].overlap);
  EXPECT_EQ(found.lines[2].words, "something else");
  EXPECT_EQ(found.lines[2].values, (std::vector<std::string>{"solve.a=1", "solve.b=2"}));
  const std::string csv = budget_csv(found), words = budget_words(found);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 6);
  EXPECT_TRUE(holds(csv, {"\"it flew, <apart>\""}));
  EXPECT_TRUE(holds(words, {"left out: no survey\n", "warning: packed fourfold\n"}));
  const Json json = budget_json(found);
  EXPECT_NEAR(json["rows"][0]["deposit_elsewhere_percent"].get<double>(), 100 * elsewhere(3), 1e-4);
  EXPECT_EQ(json["rows"][2]["warnings"], "packed fourfold");
  EXPECT_TRUE(json["rows"][3]["run_out_m"].is_null());
}

TEST_F(Budget, has_the_99th_percentile_beside_every_largest_value) {
  add("cells", "cells", 3);
  const BudgetTable found = table();
  const std::string csv = budget_csv(found), head = csv.substr(0, csv.find('\n'));
  for (const char* two : {"largest_thickness_change_m,p99_thickness_change_m",
                          "largest_speed_m_s,largest_speed_change_m_s,p99_speed_m_s,p99_speed_change_m_s"})
    EXPECT_TRUE(holds(head, {two}));
  const Json row = budget_json(found)["rows"][0];
  EXPECT_EQ(row["run_out_change_m"].get<double>(), 5);
  EXPECT_EQ(row["p99_speed_change_m_s"].get<double>(), 0.5);
  EXPECT_GT(found.lines[0].p99_change, 0);
  EXPECT_LE(found.lines[0].p99_change, found.lines[0].largest_change);
}

TEST_F(Budget, warns_where_other_last_digits_move_the_deposit) {
  const auto found = [](const BudgetTable& table) { return test::messages_of([&] { warn_of_chaos(table); }); };
  add("repeat", "repeat", 0);
  add("step", "step", 3);
  EXPECT_TRUE(found(table()).empty());
  BudgetTable moved = table();
  for (BudgetLine& line : moved.lines)
    if (line.name == "repeat") line.elsewhere = 0.09;
  ASSERT_EQ(found(moved).size(), 1u);
  EXPECT_TRUE(holds(found(moved)[0], {"9 % of the deposit"}));
}

TEST_F(Budget, spreads_over_all_rows_and_over_those_of_a_kind) {
  add("friction-less", "friction", 0, 0.5);
  add("friction-more", "friction", 0, 1.25);
  add("step", "step", 0, 1.5);
  const BudgetTable found = table();
  ASSERT_EQ(found.spreads.size(), 3u);
  int thick = 0;
  for (std::size_t i = 0; i < scene_.grid.count(); ++i) {
    const double h = runs_[0].deposit_thickness[i];
    if (!(h > 0)) continue;
    ++thick;
    EXPECT_NEAR(found.spreads[0].raster.values[i], h, 1e-5) << "from 0.5 to 1.5 of it";
    EXPECT_NEAR(found.spreads[1].raster.values[i], 0.75 * h, 1e-5) << "physical";
    EXPECT_NEAR(found.spreads[2].raster.values[i], 0.5 * h, 1e-5) << "numerical";
  }
  EXPECT_GT(thick, 4);
}

TEST_F(Budget, has_no_spread_of_a_kind_without_members_and_of_a_recipe_that_failed_is_refused) {
  add("friction-less", "friction", 0, 0.5);
  EXPECT_EQ(table().spreads.size(), 2u);
  add("step", "step", 1);
  table();
  ensemble_.counts.states[0] = MemberState::failed;
  rows_.failures[0] = "too soft";
  EXPECT_TRUE(holds(test::fault_of<DataError>([&] { budget_table(ensemble_, rows_, options_); }),
                    {"the recipe itself is not counted (too soft)"}));
}

TEST_F(Budget, scores_each_member_against_the_survey) {
  Survey survey;
  survey.name = "last year";
  survey.grid = scene_.grid;
  for (const double h : runs_[0].deposit_thickness) survey.deposit.push_back(std::max(0.0, h - 0.5));
  survey_ = survey;
  add("step", "step", 0);
  add("friction-less", "friction", 3);
  const BudgetTable found = table();
  const auto rmse = std::find(found.scores.begin(), found.scores.end(), "thickness_rmse_m") - found.scores.begin();
  ASSERT_LT(rmse, static_cast<std::ptrdiff_t>(found.scores.size()));
  const auto at = static_cast<std::size_t>(rmse);
  EXPECT_GT(found.own.scores[at], 0.1);
  EXPECT_EQ(found.lines[1].scores[at], found.own.scores[at]) << "the deposit is the same";
  EXPECT_GT(found.lines[0].scores[at], found.own.scores[at]);
  EXPECT_EQ(budget_json(found)["own"]["thickness_rmse_m"].get<double>(), found.own.scores[at]);
}

TEST_F(Budget, counts_the_coarser_cells_of_two_grids) {
  RunMaps coarse = runs_[0];
  coarse.grid.cell *= 2;
  coarse.grid.columns /= 2;
  coarse.grid.rows /= 2;
  for (auto field : {&RunMaps::deposit_thickness, &RunMaps::peak_thickness, &RunMaps::initial_thickness}) {
    std::vector<double> mean(coarse.grid.count(), 0.0);  // the same deposit, as far as such cells hold it
    for (int row = 0; row < scene_.grid.rows; ++row)
      for (int column = 0; column < scene_.grid.columns; ++column)
        mean[coarse.grid.index(column / 2, row / 2)] += 0.25 * (runs_[0].*field)[scene_.grid.index(column, row)];
    coarse.*field = std::move(mean);
  }
  add("cells", "cells", std::move(coarse));
  const BudgetTable found = table();
  EXPECT_NEAR(found.lines[0].elsewhere, 0, 1e-6);
  EXPECT_NEAR(found.lines[0].volume, found.own.volume, 1e-5 * found.own.volume);
  EXPECT_GT(found.lines[0].overlap, 0.8);
}

TEST_F(Budget, stands_on_the_page_with_its_maps) {
  add("step", "step", 1);
  add("friction-less", "friction", 2);
  const BudgetTable found = table();
  const std::string page = ensemble_html({ensemble_, options_, survey_, rows_, {}, {}, &found});
  const std::string begin = "<script type=\"application/json\" id=\"data\">";
  const auto at = page.find(begin) + begin.size();
  const Json data = Json::parse(page.substr(at, page.find("</script>", at) - at));
  ASSERT_EQ(data["budget"]["rows"].size(), 4u);
  EXPECT_EQ(data["budget"]["rows"][0]["kind"], "physical");
  EXPECT_FALSE(data["run"]["sampled"].get<bool>());
  ASSERT_EQ(data["map"]["quantities"].size(), 1u);
  EXPECT_EQ(data["map"]["quantities"][0]["statistics"]["maps"].size(), 3u);
  EXPECT_EQ(data["run"]["failures"].size(), 1u) << "what is left out has not failed";
}

TEST(Convergence, ends_on_mean_and_standard_error_of_all_in_no_more_steps_than_asked_for) {
  const Convergence steps = convergence({3, nan, 5, 7, 1}, 10);
  EXPECT_EQ(steps.members, (std::vector<std::int64_t>{1, 2, 3, 4}));
  EXPECT_EQ(steps.mean.front(), 3);
  EXPECT_TRUE(std::isnan(steps.error.front())) << "of one member";
  EXPECT_DOUBLE_EQ(steps.mean.back(), 4);
  EXPECT_DOUBLE_EQ(steps.error.back(), std::sqrt(20.0 / 3 / 4));
  std::vector<double> values(1000);
  std::iota(values.begin(), values.end(), 0);
  const Convergence few = convergence(values, 64);
  EXPECT_EQ(few.members.size(), 64u);
  EXPECT_EQ(few.members.back(), 1000);
  EXPECT_TRUE(convergence({nan, nan}, 10).members.empty());
}

/// Twice the signed area of a closed line, in half cells squared.
int area_of(const std::vector<int>& line) {
  int sum = 0;
  for (std::size_t n = 0; n + 3 < line.size(); n += 2) sum += line[n] * line[n + 3] - line[n + 2] * line[n + 1];
  return sum;
}

TEST(FootprintOutlines, are_closed_hold_corners_alone_and_end_at_the_edge_of_the_grid) {
  const MapGrid grid{.columns = 6, .rows = 5, .west = 1000, .south = 2000, .cell = 10, .crs_wkt = ""};
  std::vector<std::uint8_t> cells(grid.count(), 0);
  for (int row = 1; row < 4; ++row)
    for (int column = 1; column < 5; ++column) cells[grid.index(column, row)] = 1;
  const auto lines = footprint_outlines(cells, grid);
  ASSERT_EQ(lines.size(), 1u);
  const auto& line = lines[0];
  EXPECT_EQ(line[0], line[line.size() - 2]);
  EXPECT_EQ(line[1], line[line.size() - 1]);
  EXPECT_LE(line.size(), 2 * 10u) << "8 corners of a rectangle without its tips, the first twice, and where it begins";
  // 4 x 3 cells are 48 quarter cells; marching squares cuts an eighth of a cell off each of the four corners.
  EXPECT_EQ(std::abs(area_of(line)), 2 * (48 - 2));
  const MapGrid full{.columns = 3, .rows = 2, .west = 0, .south = 0, .cell = 5, .crs_wkt = ""};
  const auto edge = footprint_outlines(std::vector<std::uint8_t>(6, 1), full);
  ASSERT_EQ(edge.size(), 1u);
  for (std::size_t n = 0; n < edge[0].size(); n += 2) {
    EXPECT_GE(edge[0][n], 0);
    EXPECT_LE(edge[0][n], 6);
    EXPECT_GE(edge[0][n + 1], 0);
    EXPECT_LE(edge[0][n + 1], 4);
  }
}

TEST(JaccardDistance, is_one_less_the_common_share_of_any_footprints) {
  EXPECT_EQ(jaccard_distance({2, 3, 5}, {2, 3, 5}), 0);
  EXPECT_EQ(jaccard_distance({0, 4, 6}, {2, 4, 4}), 1 - 2.0 / 6);
  EXPECT_EQ(jaccard_distance({0, 4, 6}, {4, 6}), 1);
  EXPECT_EQ(jaccard_distance({10}, {10}), 0) << "both came nowhere";
  std::mt19937_64 random(11);
  for (int round = 0; round < 50; ++round) {
    std::vector<double> a(60), b(60);
    for (double& v : a) v = static_cast<double>(random() % 2);
    for (double& v : b) v = static_cast<double>(random() % 2);
    double common = 0, either = 0;
    for (std::size_t n = 0; n < a.size(); ++n) {
      common += a[n] > 0 && b[n] > 0 ? 1 : 0;
      either += a[n] > 0 || b[n] > 0 ? 1 : 0;
    }
    EXPECT_DOUBLE_EQ(jaccard_distance(footprint_of(a, 0.5), footprint_of(b, 0.5)), 1 - common / either);
  }
}

TEST(Medoids, find_the_groups_that_are_there_and_are_no_more_than_footprints_differ) {
  EnsembleCounts counts;
  const auto add = [&](const Footprint& footprint, MemberState state = MemberState::counted) {
    counts.states.push_back(state);
    counts.flow.push_back(footprint);
  };
  for (const std::int32_t reach : {10, 11, 12}) add({0, reach, 40 - reach});  // three that stay near
  add({}, MemberState::failed);
  for (const std::int32_t reach : {29, 30, 31, 30}) add({0, reach, 40 - reach});  // four that go far
  const Medoids found = medoids(counts, 2, 100);
  EXPECT_EQ(found.members, (std::vector<std::int64_t>{5, 1})) << "the middle of each group, the larger first";
  EXPECT_EQ(found.counts, (std::vector<std::int64_t>{4, 3}));
  EXPECT_EQ(found.represented_by, (std::vector<std::int64_t>{1, 1, 1, -1, 5, 5, 5, 5}));
  EnsembleCounts alike;
  alike.states.assign(5, MemberState::counted);
  alike.flow.assign(5, {0, 7, 3});
  EXPECT_EQ(medoids(alike, 3, 100).members.size(), 1u);
  EXPECT_EQ(medoids(alike, 3, 100).counts[0], 5);
}

}  // namespace
}  // namespace talus::postprocess
