// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// [budget] of a recipe, and budget.h5.
#include "common/budget/budget.hpp"

#include <gtest/gtest.h>

#include "tests/common/damage.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

BudgetOptions options_in(const std::string& table) {
  const test::Scratch scratch;
  return budget_of(recipe::Recipe(scratch.write("recipe.toml", table)));
}

void expect_refused(const std::string& table, const std::string& words) {
  try {
    options_in(table);
    FAIL() << "not refused: " << table;
  } catch (const RecipeError& error) {
    EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
  }
}

TEST(BudgetOptions, are_those_of_no_budget_where_the_recipe_says_nothing) {
  const BudgetOptions none = options_in("[solve]\n");
  EXPECT_FALSE(none.make);
  EXPECT_TRUE(none.has("cells"));
  const BudgetOptions some = options_in("[budget]\nmake = true\nleave_out = [\"cells\"]\n");
  EXPECT_TRUE(some.make);
  EXPECT_FALSE(some.has("cells"));
}

TEST(BudgetOptions, refuse_what_no_row_is_and_what_changes_nothing) {
  expect_refused("[budget]\nleave_out = [\"cell\"]\n", "cell");
  expect_refused("[budget]\ncells = 2\n", "unknown key");
  expect_refused("[budget]\ncell_factor = 1.0\n", "the other run would be the same");
  expect_refused("[budget]\nmodulus_factor = 1.0\n", "the other run would be the same");
  expect_refused("[budget]\nstep_factor = 1.0\n", "step_factor");
  expect_refused("[budget]\n[budget.elevation_error]\nterrain_deviation_m = 1.0\n",
                 "[budget.elevation_error] range_m is missing");
  std::string all;
  for (const BudgetRow& row : budget_rows)
    if (row.name != std::string("own") && row.name != std::string("own-numerical"))
      all += std::string("\"") + row.name + "\", ";
  expect_refused("[budget]\nleave_out = [" + all + "]\n", "names all rows");
  const std::string own = "[[budget.run]]\nname = \"law\"\nset = [\"solve.base.law=voellmy\"]\n";
  EXPECT_EQ(options_in("[budget]\nleave_out = [" + all + "]\n" + own).changes.size(), 1u) << "a run of its own is left";
  expect_refused(own + own, "[[budget.run]] \"law\" is there twice");
  expect_refused("[[budget.run]]\nname = \"a/b\"\nset = [\"solve.cfl=0.1\"]\n", "letters, digits");
  expect_refused("[[budget.run]]\nname = \"nothing\"\n", "sets nothing");
}

Budget small_budget() {
  const MapGrid grid{.columns = 4, .rows = 3, .west = 10, .south = 20, .cell = 5, .crs_wkt = {}};
  Raster map{grid, std::vector<double>(12, 0.5)};
  map.values[3] = nan;
  BudgetRun done{.name = "step", .row = "step", .words = "steps half as long", .values = {"solve.cfl=0.25", "a=b"}};
  done.state = BudgetState::done;
  done.result.run_out = 12.5;
  done.result.p99_speed = 7.5;
  done.accepted = {{"accepted.weight-strain", "too soft"}};
  done.warnings = {"packed fourfold", "fast"};
  done.deposit = done.peak_thickness = map;
  BudgetRun failed{.name = "modulus", .row = "modulus", .words = "stiff", .values = {}};
  failed.state = BudgetState::failed;
  failed.reason = "too soft";
  BudgetRun left_out{.name = "survey-1", .row = "survey", .words = "another error", .values = {}, .domain = "survey-1"};
  left_out.state = BudgetState::left_out;
  left_out.reason = "no survey";
  return {.fingerprint = "f",
          .run = "r",
          .options = "[budget]\n",
          .runs = {done, failed, left_out},
          .provenance = {{"domain.id", "d"}}};
}

TEST(BudgetFile, gives_back_what_was_written) {
  const test::Scratch scratch;
  const Budget budget = small_budget();
  write_budget(scratch / "budget.h5", budget);
  const Budget read = read_budget(scratch / "budget.h5");
  EXPECT_EQ(read.fingerprint, "f");
  EXPECT_EQ(read.run, "r");
  EXPECT_EQ(read.provenance, budget.provenance);
  ASSERT_EQ(read.runs.size(), 3u);
  EXPECT_EQ(read.runs[0].values, budget.runs[0].values);
  EXPECT_EQ(read.runs[0].accepted, budget.runs[0].accepted);
  EXPECT_TRUE(read.runs[1].accepted.empty());
  EXPECT_EQ(read.runs[0].warnings, budget.runs[0].warnings);
  EXPECT_TRUE(read.runs[1].warnings.empty());
  EXPECT_EQ(read.runs[0].result.run_out, 12.5);
  EXPECT_EQ(read.runs[0].result.p99_speed, 7.5);
  EXPECT_TRUE(std::isnan(read.runs[0].result.drop));
  EXPECT_EQ(read.runs[0].deposit.grid.columns, 4);
  EXPECT_EQ(read.runs[0].deposit.values[0], 0.5);
  EXPECT_TRUE(std::isnan(read.runs[0].deposit.values[3]));
  EXPECT_EQ(read.runs[1].reason, "too soft");
  EXPECT_EQ(read.runs[2].domain, "survey-1");
  EXPECT_EQ(read.count(BudgetState::done), 1u);
  EXPECT_EQ(read.count(BudgetState::left_out), 1u);
}

TEST(BudgetFile, refuses_rows_that_no_budget_has_and_thickness_below_zero) {
  const test::Scratch scratch;
  Budget budget = small_budget();
  budget.runs[1].row = "colour";
  write_budget(scratch / "row.h5", budget);
  EXPECT_THROW(read_budget(scratch / "row.h5"), DataError);
  budget = small_budget();
  budget.runs[0].deposit.values[2] = -1;
  write_budget(scratch / "thickness.h5", budget);
  EXPECT_THROW(read_budget(scratch / "thickness.h5"), DataError);
}

TEST(BudgetFile, refuses_a_file_that_was_cut_short) {
  const test::Scratch scratch;
  write_budget(scratch / "budget.h5", small_budget());
  const auto size = std::filesystem::file_size(scratch / "budget.h5");
  std::filesystem::resize_file(scratch / "budget.h5", size - 100);
  EXPECT_THROW(read_budget(scratch / "budget.h5"), DataError);
}

TEST(BudgetFile, without_its_seal_and_damaged_is_refused_or_read) {
  const test::Scratch scratch;
  write_budget(scratch / "budget.h5", small_budget());
  EXPECT_THROW(read_budget(scratch.write("unsealed.h5", test::without_seal(scratch / "budget.h5"))), DataError);
  const std::string bytes = test::text_of(scratch / "budget.h5");
  const int refused = test::refused_of(50, bytes, [](const std::filesystem::path& file) { read_budget(file); });
  EXPECT_EQ(refused, 50) << "the seal tells";
}

}  // namespace
}  // namespace talus
