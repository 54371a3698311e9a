// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// When the iterations of a step are given up.
#include "solver/implicit/stall.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::solver::testing {
namespace {

/// The iteration at which a step with this residual is given up; -1: none of a hundred.
template <class Residual>
int given_up_at(int patience, const Residual& residual) {
  Stall stall(patience);
  for (int n = 0; n < 100; ++n) {
    if (stall.gives_up(residual(n))) return n;
  }
  return -1;
}

TEST(Stall, gives_up_when_the_residual_stays) {
  EXPECT_EQ(given_up_at(7, [](int) { return 0.01; }), 7);
  // A first fall, then nothing: so many iterations after the last halving. Growth is none.
  EXPECT_EQ(given_up_at(7, [](int n) { return n < 5 ? std::pow(0.4, n) : 0.05 * n; }), 4 + 7);
}

TEST(Stall, waits_while_the_residual_halves_now_and_then) {
  EXPECT_EQ(given_up_at(7, [](int n) { return std::pow(0.9, n); }), -1) << "it halves in 6.6 iterations";
  EXPECT_EQ(given_up_at(6, [](int n) { return std::pow(0.9, n); }), 6);
}

TEST(Stall, never_gives_up_unasked) {
  EXPECT_EQ(given_up_at(0, [](int) { return 0.01; }), -1);
}

}  // namespace
}  // namespace talus::solver::testing
