// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// [ensemble.budget] of a recipe.
#include "common/ensemble/budget_options.hpp"

#include <gtest/gtest.h>

#include "common/ensemble/options.hpp"
#include "tests/common/scratch.hpp"

namespace talus {
namespace {

const std::string heading = "[ensemble]\ndesign = \"budget\"\n[ensemble.budget]\n";

EnsembleOptions options_in(const std::string& table) {
  const test::Scratch scratch;
  return ensemble_of(recipe::Recipe(scratch.write("recipe.toml", table)));
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
  EXPECT_FALSE(options_in("[solve]\n").on());
  const EnsembleOptions some = options_in(heading + "leave_out = [\"cells\"]\n");
  EXPECT_TRUE(some.on());
  EXPECT_TRUE(some.is_budget());
  EXPECT_FALSE(some.budget.has("cells"));
}

TEST(BudgetOptions, of_the_table_of_before_are_refused_with_advice) {
  expect_refused("[budget]\ncell_factor = 3.0\n", "Give its keys in [ensemble.budget], with design = \"budget\"");
}

TEST(BudgetOptions, refuse_what_no_row_is_and_what_changes_nothing) {
  expect_refused(heading + "leave_out = [\"cell\"]\n", "cell");
  expect_refused(heading + "cells = 2\n", "unknown key");
  expect_refused(heading + "cell_factor = 1.0\n", "the other run would be the same");
  expect_refused(heading + "modulus_factor = 3.0\n", "the modulus is doubled");
  expect_refused(heading + "step_factor = 0.1\n", "steps are halved");
  expect_refused(heading + "[ensemble.elevation_error]\nterrain_deviation_m = 1.0\n",
                 "[ensemble.elevation_error] range_m is missing");
  std::string all;
  for (const BudgetRow& row : budget_rows)
    if (row.name != std::string("own") && row.name != std::string("own-numerical"))
      all += std::string("\"") + row.name + "\", ";
  expect_refused(heading + "leave_out = [" + all + "]\n", "names all rows");
  const std::string own = "[[ensemble.budget.run]]\nname = \"law\"\nset = [\"solve.base.law=voellmy\"]\n";
  EXPECT_EQ(options_in(heading + "leave_out = [" + all + "]\n" + own).budget.changes.size(), 1u)
      << "a run of its own is left";
  expect_refused(heading + own + own, "[[ensemble.budget.run]] \"law\" is there twice");
  expect_refused(heading + "[[ensemble.budget.run]]\nname = \"a/b\"\nset = [\"solve.cfl=0.1\"]\n", "letters, digits");
  expect_refused(heading + "[[ensemble.budget.run]]\nname = \"nothing\"\n", "sets nothing");
}

TEST(BudgetOptions, list_the_recipe_itself_and_every_row_that_is_not_left_out) {
  std::string names;
  for (const BudgetMember& member :
       budget_members(options_in(heading + "leave_out = [\"transfer\", \"weakening\"]\nsurvey_draws = 2\n"
                                           "[[ensemble.budget.run]]\nname = \"other\"\nset = [\"solve.cfl=0.1\"]\n")
                          .budget))
    names += member.name + (member.name.starts_with(member.row) ? " " : " of " + member.row + " ");
  EXPECT_EQ(names,
            "recipe step modulus integrator cells friction-less friction-more drag-less drag-more strength-less "
            "strength-more survey-1 survey-2 other of own ");
}

}  // namespace
}  // namespace talus
