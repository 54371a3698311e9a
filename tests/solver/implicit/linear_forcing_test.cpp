// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How exactly linear systems are asked for.
#include "solver/implicit/linear_forcing.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

ImplicitControls controls(double tolerance, Forcing forcing) {
  ImplicitControls c;
  c.tolerance = tolerance;
  c.forcing = forcing;
  c.linear_tolerance = 1e-8;
  return c;
}

TEST(LinearForcing, asks_for_as_much_as_the_last_iteration_brought) {
  const ImplicitControls c = controls(1e-6, Forcing::eisenstat_walker);
  LinearForcing forcing;
  EXPECT_EQ(forcing.next(1, c), 1e-3);
  EXPECT_DOUBLE_EQ(forcing.next(0.1, c), 0.9 * 0.01);
  EXPECT_DOUBLE_EQ(forcing.next(0.1, c), 0.1) << "no progress: at most this";
  EXPECT_DOUBLE_EQ(forcing.next(1e-5, c), 0.01) << "no finer than Newton's own tolerance asks for";
}

TEST(LinearForcing, keeps_to_one_tolerance_where_that_is_asked_for) {
  const ImplicitControls c = controls(1e-6, Forcing::fixed);
  LinearForcing forcing;
  for (const double residual : {1.0, 0.5, 1e-5}) EXPECT_EQ(forcing.next(residual, c), 1e-8);
}

TEST(LinearForcing, asks_for_no_more_than_the_finest_tolerance) {
  const ImplicitControls c = controls(1e-12, Forcing::eisenstat_walker);
  LinearForcing forcing;
  forcing.next(1, c);
  EXPECT_EQ(forcing.next(1e-5, c), 1e-8);
}

}  // namespace
}  // namespace talus::solver::testing
