// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The rows of the validation: what is judged, what is noted, and what the table and its JSON say of either.
#include "tests/validation/report.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

namespace talus::validation {
namespace {

/// The rows that a case makes of a run which went well, or ended with a fault.
std::vector<Row> rows_of(const std::string& fault, const std::function<void(Bench&, const Outcome&)>& judge) {
  std::vector<Row> rows;
  const Request request;
  Bench bench("X1", request, [&](const Row& row) { rows.push_back(row); });
  Outcome outcome;
  outcome.variant = "some grid";
  outcome.fault = fault;
  judge(bench, outcome);
  return rows;
}

/// A row that is met, one that misses, and one that claims nothing.
void three_rows(Bench& bench, const Outcome& o) {
  bench.compare(o, "way", 1.005, 1, 0.01);
  bench.compare(o, "height", 1.05, 1, 0.01);
  bench.note(o, "speed", 3);
}

nlohmann::json json_of(const std::vector<Row>& rows) {
  const Sitting sitting{
      .commit = "1a2b3c4d5", .date = "2026-11-22", .on = "cpu", .complete = false, .coarse = false, .cases = {"X1"}};
  return nlohmann::json::parse(as_json(sitting, rows));
}

TEST(Report, tells_noted_rows_from_judged_ones) {
  const auto json = json_of(rows_of("", three_rows));
  const auto& rows = json.at("rows");
  ASSERT_EQ(rows.size(), 3);
  EXPECT_EQ(rows[0].at("judged"), true);
  EXPECT_EQ(rows[0].at("pass"), true);
  EXPECT_EQ(rows[1].at("judged"), true);
  EXPECT_EQ(rows[1].at("pass"), false);
  EXPECT_EQ(rows[2].at("judged"), false);
  EXPECT_EQ(rows[2].at("computed"), 3);
  for (const char* claim : {"pass", "error", "tolerance", "reference"})
    EXPECT_FALSE(rows[2].contains(claim)) << "a noted row claims " << claim;
}

TEST(Report, names_the_commit_and_the_day) {
  const auto json = json_of(rows_of("", three_rows));
  EXPECT_EQ(json.at("commit"), "1a2b3c4d5");
  EXPECT_EQ(json.at("date"), "2026-11-22");
  EXPECT_EQ(json.at("cases").size(), 1);
}

TEST(Report, counts_noted_rows_apart) {
  const auto rows = rows_of("", three_rows);
  const Counts c = count(rows);
  EXPECT_EQ(c.judged, 2);
  EXPECT_EQ(c.missed, 1);
  EXPECT_EQ(c.noted, 1);
  EXPECT_EQ(c.lost, 0);
  const std::string table = as_table(rows);
  EXPECT_NE(table.find("3 rows: 2 judged, of which 1 failed; 1 noted, of which 0 without a result"), std::string::npos)
      << table;
  EXPECT_NE(table.find(" noted "), std::string::npos) << table;
}

TEST(Report, of_a_run_without_a_result_passes_nothing) {
  const auto rows = rows_of("exit code 4: no step converges", three_rows);
  const Counts c = count(rows);
  EXPECT_EQ(c.missed, 2);
  EXPECT_EQ(c.lost, 1);
  const auto json = json_of(rows);
  EXPECT_TRUE(json.at("rows")[2].at("computed").is_null());
  EXPECT_EQ(json.at("rows")[2].at("fault"), "exit code 4: no step converges");
  EXPECT_NE(as_table(rows).find("no step converges"), std::string::npos);
}

TEST(Costs, may_grow_by_fifteen_per_cent_and_two) {
  EXPECT_EQ(cost_bound(0), 2);
  EXPECT_EQ(cost_bound(20), 25);
  EXPECT_EQ(cost_bound(1000), 1152);
  EXPECT_LT(cost_bound(880), 1554) << "what once went unnoticed";
}

TEST(Costs, are_read_as_they_were_written) {
  const auto file = std::filesystem::path(::testing::TempDir()) / "costs.toml";
  const CostBook book{{"A1 quasi-static, quadratic, pcg", {20, 40, 880}}, {"B3 20 m", {2690, 0, 0}}};
  std::ofstream(file) << as_toml(book);
  const CostBook read = read_costs(file);
  ASSERT_EQ(read.size(), 2);
  EXPECT_EQ(read.at("A1 quasi-static, quadratic, pcg").linear, 880);
  EXPECT_EQ(read.at("B3 20 m").steps, 2690);
  std::ofstream(file) << "\"A1\" = [20, 40]\n";
  EXPECT_THROW(read_costs(file), std::runtime_error);
  std::filesystem::remove(file);
  EXPECT_TRUE(read_costs(file).empty());
}

}  // namespace
}  // namespace talus::validation
