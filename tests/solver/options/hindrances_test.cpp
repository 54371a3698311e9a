// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a recipe holds that a way of stepping cannot do, and why.
#include "solver/options/hindrances.hpp"

#include <gtest/gtest.h>

#include "solver/options/solve.hpp"

namespace talus::solver {
namespace {

TEST(Hindrances, none_stand_in_the_way_of_a_plain_recipe) {
  const SolveOptions o;
  EXPECT_FALSE(beyond_columns(o));
  EXPECT_FALSE(beyond_rest(o));
}

TEST(Hindrances, of_columns_are_walls_above) {
  SolveOptions contact;
  contact.obstacles.emplace_back();
  EXPECT_FALSE(beyond_columns(contact));
  SolveOptions floor;
  floor.walls.push_back({.axis = Axis::z, .material_is = Side::above});
  EXPECT_FALSE(beyond_columns(floor));
  SolveOptions lid;
  lid.walls.push_back({.axis = Axis::z, .material_is = Side::below});
  EXPECT_EQ(beyond_columns(lid).key, "a [[solve.wall]] across z above the material");
}

TEST(Hindrances, of_rest_are_named_by_their_key) {
  const auto key = [](auto change) {
    SolveOptions o;
    change(o);
    return beyond_rest(o).key;
  };
  EXPECT_EQ(key([](SolveOptions& o) { o.material.model = MaterialModel::mu_of_i; }), "model = \"mu-of-i\"");
  EXPECT_EQ(key([](SolveOptions& o) { o.base.separation = Separation::thin; }), "[solve.base] separation = \"thin\"");
  EXPECT_EQ(key([](SolveOptions& o) { o.deterministic = true; }), "[solve] deterministic = true");
  EXPECT_EQ(key([](SolveOptions& o) { o.energy_budget = true; }), "[solve] energy_budget = true");
}

}  // namespace
}  // namespace talus::solver
