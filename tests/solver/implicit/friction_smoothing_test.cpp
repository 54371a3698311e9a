// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Over which slip friction grows, from step to step and within one.
#include "solver/implicit/friction_smoothing.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

TEST(FrictionSmoothing, widens_by_tens_and_narrows_by_halves) {
  FrictionSmoothing s{.smooths = true, .gravity_way = 2};
  EXPECT_EQ(s.slip(), 2e-5);
  EXPECT_DOUBLE_EQ(s.head_start(), 2e-3);
  int times = 0;
  while (s.widen()) ++times;
  EXPECT_EQ(times, 4);
  EXPECT_EQ(s.width, FrictionSmoothing::widest);
  EXPECT_TRUE(s.too_wide_for(0.1));
  EXPECT_FALSE(s.too_wide_for(10));
  s.narrow_after(100);
  EXPECT_EQ(s.width, FrictionSmoothing::widest) << "that step did not converge well";
  s.narrow_after(3);
  EXPECT_EQ(s.width, 0.5 * FrictionSmoothing::widest);
  for (int i = 0; i < 9; ++i) s.narrow();
  EXPECT_EQ(s.width, FrictionSmoothing::narrowest);
  EXPECT_FALSE(s.too_wide_for(0));
  s.smooths = false;
  EXPECT_FALSE(s.widen());
}

}  // namespace
}  // namespace talus::solver::testing
