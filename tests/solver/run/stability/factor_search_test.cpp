// The bracket of the largest factor that holds.
#include "solver/run/stability/factor_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

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

TEST(FactorSearch, tries_no_more_often_than_the_bracket_asks_for) {
  int tries = 0;
  bracket_factor([&](double factor) { return ++tries, factor <= 1.38; }, {.tolerance = 0.005});
  EXPECT_LE(tries, 3 + 6);  // 1, 1.25, 1.56; six halvings of 0.31 are below 0.005 of 1.38
}

}  // namespace
}  // namespace talus::solver::testing
