// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/usual_reach.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

/// Frank Slide, 36 million m3: H/L of 0.28 (Scheidegger) and 0.20 (Corominas); about 0.25 was observed.
TEST(UsualReach, holds_the_published_regressions) {
  const auto regressions = reach_regressions();
  ASSERT_EQ(regressions.size(), 2u);
  EXPECT_NEAR(regressions[0].tangent(36e6), 0.2757, 1e-3);
  EXPECT_NEAR(regressions[1].tangent(36e6), 0.2045, 1e-3);
  EXPECT_NEAR(regressions[1].tangent(1e6), 0.2773, 1e-3);  // 10^(-0.047 - 0.51)
}

TEST(UsualReach, is_bounded_by_those_that_hold_for_a_volume) {
  const ReachBounds large = usual_reach(36e6), small = usual_reach(5e4), none = usual_reach(10);
  EXPECT_NEAR(large.low, 0.2045 / 2, 1e-3);
  EXPECT_NEAR(large.high, 0.2757 * 2, 1e-3);
  EXPECT_NEAR(small.high / small.low, 4, 1e-9);  // one regression alone
  EXPECT_EQ(none.high, 0);
}

}  // namespace
}  // namespace talus
