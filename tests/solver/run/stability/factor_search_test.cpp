// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bracket of the largest factor that holds.
#include "solver/run/stability/factor_search.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace talus::solver::testing {
namespace {

FactorBracket bracket_of(double limit, double tolerance = 0.005) {
  return bracket_factor([&](double factor) { return factor <= limit; }, {.tolerance = tolerance});
}

TEST(FactorSearch, encloses_a_limit_above_and_below_one_within_the_tolerance) {
  for (const double limit : {0.0723, 0.4, 0.999, 1.0, 1.001, 1.38, 7.3, 19.9}) {
    const FactorBracket found = bracket_of(limit);
    EXPECT_LE(found.low, limit);
    EXPECT_GT(found.high, limit);
    EXPECT_LE(found.high - found.low, 0.005 * found.low) << limit;
    EXPECT_TRUE(found.closed());
  }
}

TEST(FactorSearch, says_when_all_or_none_held) {
  const FactorBracket all = bracket_of(1e9), none = bracket_of(1e-9);
  EXPECT_EQ(all.low, 20);
  EXPECT_TRUE(std::isinf(all.high));
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0.01);
  EXPECT_FALSE(all.closed() || none.closed());
}

TEST(FactorSearch, goes_on_from_what_is_known) {
  std::vector<double> tried;
  const FactorBracket found = bracket_factor([&](double factor) { return tried.push_back(factor), factor <= 2; },
                                             {.tolerance = 0.005}, {.low = 1.6});
  EXPECT_LE(found.low, 2);
  EXPECT_GT(found.high, 2);
  EXPECT_EQ(tried.front(), 1.02 * 1.6) << "neither 1 again nor below what held: what is known may be near the limit";
  EXPECT_LT(tried.size(), 14U) << "and it may be far from it";
}

TEST(FactorSearch, tries_no_more_often_than_the_bracket_asks_for) {
  int tries = 0;
  bracket_factor([&](double factor) { return ++tries, factor <= 1.38; }, {.tolerance = 0.005});
  EXPECT_LE(tries, 3 + 6);  // 1, 1.25, 1.56; six halvings of 0.31 are below 0.005 of 1.38
}

}  // namespace
}  // namespace talus::solver::testing
