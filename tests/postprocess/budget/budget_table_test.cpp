// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of an error budget: shares, order, scores and spread of runs whose deposits are known.
#include "postprocess/budget/budget_table.hpp"

#include <cmath>

#include "common/map/statistics.hpp"
#include "common/stage/identity.hpp"
#include "tests/postprocess/report/report_of_run.hpp"

namespace talus::postprocess {
namespace {

class BudgetOfRun : public ReportOfRun {
 protected:
  BudgetOfRun() {
    run_.summary.provenance.emplace_back(run_id, "1234");
    budget_.run = "1234";
  }

  /// A run whose deposit is that of the run itself, moved by whole columns to the east, times a factor.
  BudgetRun& add(const std::string& name, const std::string& row, int columns, double factor = 1) {
    BudgetRun run{.name = name, .row = row, .words = "something else", .values = {}};
    run.state = BudgetState::done;
    const RunMaps& maps = run_.maps;
    run.deposit = run.peak_thickness = {maps.grid, std::vector<double>(maps.grid.count(), 0.0)};
    for (int row_of_map = 0; row_of_map < maps.grid.rows; ++row_of_map)
      for (int column = columns; column < maps.grid.columns; ++column) {
        const std::size_t to = maps.grid.index(column, row_of_map),
                          from = maps.grid.index(column - columns, row_of_map);
        run.deposit.values[to] = factor * std::fmax(maps.deposit_thickness[from], 0);
        run.peak_thickness.values[to] = std::fmax(maps.peak_thickness[from], 0);
      }
    run.result.run_out = 100;
    run.result.largest_speed = 10;
    run.result.p99_speed = 8;
    budget_.runs.push_back(run);
    return budget_.runs.back();
  }

  std::optional<BudgetTable> table() {
    write_budget(scratch_ / "budget.h5", budget_);
    return budget_table(scratch_ / "budget.h5", {run_, options_, survey_, thalweg_});
  }

  /// Half the sum of the differences over the volume, by hand.
  double elsewhere(const BudgetRun& run) const {
    double moved = 0, ours = 0, theirs = 0;
    for (std::size_t i = 0; i < run.deposit.values.size(); ++i) {
      ours += std::fmax(run_.maps.deposit_thickness[i], 0);
      theirs += run.deposit.values[i];
    }
    for (std::size_t i = 0; i < run.deposit.values.size(); ++i)
      moved += std::abs(std::fmax(run_.maps.deposit_thickness[i], 0) - run.deposit.values[i] * ours / theirs);
    return 0.5 * moved / ours;
  }

  Budget budget_;
};

TEST_F(BudgetOfRun, is_that_of_its_runs_the_largest_first) {
  const double twice = elsewhere(add("step", "step", 0, 2)), one = elsewhere(add("friction-less", "friction", 1)),
               three = elsewhere(add("cells", "cells", 3));
  BudgetRun failed{.name = "modulus", .row = "modulus", .words = "stiff", .values = {}};
  failed.state = BudgetState::failed;
  failed.reason = "it flew, <apart>";
  budget_.runs.insert(budget_.runs.begin(), failed);
  const auto found = table();
  ASSERT_TRUE(found);
  ASSERT_EQ(found->lines.size(), 4u);
  EXPECT_EQ(twice, 0) << "volumes are set equal";
  EXPECT_GT(three, one);
  const char* names[] = {"cells", "friction-less", "step", "modulus"};
  const double sizes[] = {three, one, twice};
  for (std::size_t n = 0; n < 4; ++n) EXPECT_EQ(found->lines[n].run.name, names[n]);
  for (std::size_t n = 0; n < 3; ++n) EXPECT_NEAR(found->lines[n].elsewhere, sizes[n], 1e-12) << names[n];
  EXPECT_NEAR(found->lines[2].numbers.volume, 2 * found->own.volume, 1e-9 * found->own.volume);
  EXPECT_EQ(found->lines[2].overlap, 1);
  EXPECT_LT(found->lines[0].overlap, found->lines[1].overlap);
  EXPECT_EQ(found->compared(BudgetKind::numerical), 2u);
  EXPECT_EQ(found->compared(BudgetKind::physical), 1u);
  const std::string csv = budget_csv(*found);
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 5);
  EXPECT_NE(csv.find("\"it flew, <apart>\""), std::string::npos) << csv;
  const Json json = Json::parse(budget_json_text(*found, run_));
  EXPECT_NEAR(json["rows"][0]["deposit_elsewhere_percent"].get<double>(), 100 * three, 1e-9);
  EXPECT_TRUE(json["rows"][3]["run_out_m"].is_null());
}

TEST_F(BudgetOfRun, has_the_99th_percentile_beside_every_largest_value) {
  add("cells", "cells", 3);
  const auto found = table();
  ASSERT_TRUE(found);
  const std::string csv = budget_csv(*found), head = csv.substr(0, csv.find('\n'));
  for (const char* two : {"largest_thickness_change_m,p99_thickness_change_m",
                          "largest_speed_m_s,largest_speed_change_m_s,p99_speed_m_s,p99_speed_change_m_s"})
    EXPECT_NE(head.find(two), std::string::npos) << head;
  const Json json = Json::parse(budget_json_text(*found, run_));
  const double own = p99_of_positive(run_.maps.peak_speed);
  EXPECT_EQ(json["own"]["p99_speed_m_s"].get<double>(), own);
  EXPECT_EQ(json["rows"][0]["p99_speed_m_s"].get<double>(), 8);
  EXPECT_EQ(json["rows"][0]["p99_speed_change_m_s"].get<double>(), 8 - own);
  EXPECT_GT(found->lines[0].p99_change, 0);
  EXPECT_LE(found->lines[0].p99_change, found->lines[0].largest_change);
}

TEST_F(BudgetOfRun, says_of_each_run_what_was_insisted_on) {
  BudgetRun& soft = add("modulus", "modulus", 1);
  soft.accepted = {{"accepted.weight-strain", "soft, <b>by far"}};
  soft.warnings = {"packed fourfold"};
  add("step", "step", 0);
  const auto found = table();
  ASSERT_TRUE(found);
  const Json rows = Json::parse(budget_json_text(*found, run_))["rows"];
  EXPECT_EQ(rows[0]["accepted.weight-strain"], "soft, <b>by far");
  EXPECT_FALSE(rows[1].contains("accepted.weight-strain"));
  const std::string words = budget_words(*found);
  EXPECT_NE(words.find("accepted: weight-strain: soft, <b>by far\n"), std::string::npos) << words;
  ReportInput with = input();
  with.budget = &*found;
  const Json lines = data_of(report_html(with))["budget"]["lines"];
  EXPECT_EQ(lines[0]["accepted"], "weight-strain: soft, <b>by far");
  EXPECT_EQ(lines[1]["accepted"], "");
  EXPECT_EQ(lines[0]["warnings"], Json::array({"packed fourfold"}));
  EXPECT_EQ(rows[0]["warnings"], Json::array({"packed fourfold"}));
  EXPECT_FALSE(rows[1].contains("warnings"));
  EXPECT_NE(words.find("warning: packed fourfold\n"), std::string::npos) << words;
}

TEST_F(BudgetOfRun, spreads_over_all_rows_and_over_those_of_a_kind) {
  add("friction-less", "friction", 0, 0.5);
  add("friction-more", "friction", 0, 1.25);
  add("step", "step", 0, 1.5);
  const auto found = table();
  ASSERT_TRUE(found);
  int thick = 0;
  for (std::size_t i = 0; i < run_.maps.grid.count(); ++i) {
    const double h = run_.maps.deposit_thickness[i];
    if (!(h > 0)) continue;
    ++thick;
    EXPECT_NEAR(found->spread.values[i], h, 1e-12) << "from 0.5 to 1.5 of it";
    EXPECT_NEAR(found->spread_physical.values[i], 0.75 * h, 1e-12);
    EXPECT_NEAR(found->spread_numerical.values[i], 0.5 * h, 1e-12);
  }
  EXPECT_GT(thick, 4);
  budget_.runs.pop_back();
  EXPECT_TRUE(table()->spread_numerical.values.empty()) << "no such row is left";
}

TEST_F(BudgetOfRun, scores_each_run_against_the_survey) {
  survey_it();
  add("step", "step", 0);
  add("friction-less", "friction", 3);
  const auto found = table();
  ASSERT_TRUE(found);
  ASSERT_FALSE(found->scores.empty());
  const Score own = make_score(run_, options_, survey_, thalweg_);
  for (std::size_t s = 0; s < found->scores.size(); ++s) {
    const BudgetScore& score = found->scores[s];
    EXPECT_EQ(score.own, own.number(score.key)) << score.key;
    EXPECT_NEAR(found->lines[1].scores[s], score.own, 1e-12) << score.key << ": the deposit is the same";
    if (score.key == "thickness_rmse_m") {
      EXPECT_GT(found->lines[0].scores[s], score.own);
    }
  }
}

TEST_F(BudgetOfRun, counts_the_coarser_cells_of_two_grids) {
  BudgetRun& coarse = add("cells", "cells", 0);
  MapGrid grid = run_.maps.grid;
  grid.cell *= 2;
  grid.columns /= 2;
  grid.rows /= 2;
  Raster map{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < 2 * grid.rows;
       ++row)  // the mean of four cells: the same deposit, as far as such cells hold it
    for (int column = 0; column < 2 * grid.columns; ++column)
      map.values[grid.index(column / 2, row / 2)] += 0.25 * coarse.deposit.values[run_.maps.grid.index(column, row)];
  coarse.deposit = coarse.peak_thickness = map;
  const auto found = table();
  ASSERT_TRUE(found);
  EXPECT_NEAR(found->lines[0].elsewhere, 0, 1e-12);
}

TEST_F(BudgetOfRun, of_another_run_is_left_out) {
  add("step", "step", 1);
  budget_.run = "5678";
  EXPECT_FALSE(table());
  EXPECT_FALSE(budget_table(scratch_ / "none.h5", {run_, options_, survey_, thalweg_}));
}

TEST_F(BudgetOfRun, stands_in_the_report_with_its_maps) {
  add("step", "step", 1);
  add("friction-less", "friction", 2);
  const auto found = table();
  ASSERT_TRUE(found);
  ReportInput with = input();
  with.budget = &*found;
  const Json data = data_of(report_html(with));
  ASSERT_EQ(data["budget"]["lines"].size(), 2u);
  EXPECT_EQ(data["budget"]["lines"][0]["kind"], "physical");
  std::vector<std::string> layers;
  for (const Json& layer : data["map"]["layers"]) layers.push_back(layer["id"]);
  for (const char* id : {"spread", "spread_physical", "spread_numerical"})
    EXPECT_NE(std::find(layers.begin(), layers.end(), id), layers.end()) << id;
  EXPECT_TRUE(data_of(report_html(input()))["budget"].is_null());
}

}  // namespace
}  // namespace talus::postprocess
