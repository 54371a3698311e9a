// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The factors by slices against published ones.
#include "tests/validation/slices.hpp"

#include <gtest/gtest.h>

namespace talus::validation {
namespace {

TEST(slices, have_the_factor_of_bishop_and_morgensterns_chart) {
  // 1960: 2:1, phi = 20 deg, c = 0.05, firm base at the toe; 1.380 by their charts (in Griffiths & Lane 1999).
  EXPECT_NEAR(bishop_factor({.cohesion = 0.05, .friction = 20}), 1.380, 0.004);
}

TEST(slices, have_taylors_factor_of_clay) {
  // 1937: 2:1, phi = 0, c = 0.25, firm base one height below the toe; 1.47 (in Griffiths & Lane 1999).
  EXPECT_NEAR(bishop_factor({.cohesion = 0.25, .base = 2}), 1.47, 0.005);
}

TEST(slices, go_through_the_toe_above_a_foundation_of_the_same_ground) {
  // Griffiths & Lane 1999, example 2: the foundation lets circles dip below the toe, which changes little; those that
  // touch its base have 1.75.
  const double deep = bishop_factor({.cohesion = 0.05, .friction = 20, .base = 1.5});
  EXPECT_LT(deep, bishop_factor({.cohesion = 0.05, .friction = 20}));
  EXPECT_NEAR(deep, 1.37, 0.01);
}

TEST(slices, lose_as_much_as_the_water_carries) {
  // F falls linearly with r_u (Bishop & Morgenstern 1960), as long as the circle stays where it is.
  const auto factor = [](double water) { return bishop_factor({.cohesion = 0.05, .friction = 20, .water = water}); };
  const double dry = factor(0), first = dry - factor(0.25), second = factor(0.25) - factor(0.5);
  EXPECT_GT(first, 0.2);
  EXPECT_NEAR(first, second, 0.02);
}

}  // namespace
}  // namespace talus::validation
