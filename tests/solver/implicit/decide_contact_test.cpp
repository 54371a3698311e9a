// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The active set of contacts, node by node: opening, closing, slipping, sticking again.
#include "solver/implicit/decide_contact.hpp"

#include <gtest/gtest.h>

#include "tests/solver/implicit/one_node.hpp"

namespace talus::solver::testing {
namespace {

TEST(DecideContact, keeps_what_friction_can_hold) {
  OneNode n;
  EXPECT_FALSE(n.decide({4, 0, -10}));
  EXPECT_EQ(n.touch, Touch::sticks);
  EXPECT_EQ(n.limit, 5);
}

TEST(DecideContact, lets_slip_what_friction_cannot_hold) {
  OneNode n;
  EXPECT_TRUE(n.decide({3, -4.5, -10}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_NEAR(length(n.direction), 1, 1e-15);
  EXPECT_NEAR(n.direction.x / n.direction.y, -3 / 4.5, 1e-15);
  EXPECT_EQ(n.freed.xx, 1);
  EXPECT_EQ(n.freed.zz, 0) << "the normal is held while it presses";
  EXPECT_EQ(n.changes.turns, 1);
  EXPECT_EQ(n.changes.closings, 0);
}

TEST(DecideContact, opens_where_the_contact_would_pull) {
  OneNode n;
  EXPECT_FALSE(n.decide({0, 0, 0.5e-9})) << "rounding must not open it";
  EXPECT_TRUE(n.decide({0, 0, 1}));
  EXPECT_EQ(n.touch, Touch::open);
  EXPECT_EQ(n.freed.zz, 1);
}

TEST(DecideContact, closes_where_the_node_moves_in) {
  OneNode n;
  n.touch = Touch::open;
  n.u = {0.1, 0, 0.2};
  EXPECT_FALSE(n.decide({0, 0, -1}));
  n.u.z = -0.2;
  EXPECT_TRUE(n.decide({0, 0, -1}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_EQ(n.u.x, 0.1);
  EXPECT_EQ(n.u.z, 0);
  EXPECT_EQ(n.changes.closings, 1);
  EXPECT_EQ(n.changes.turns, 0);
}

TEST(DecideContact, stays_closed_once_it_has_closed_three_times) {
  OneNode n;
  for (int time = 0; time < 3; ++time) {
    EXPECT_TRUE(n.decide({0, 0, 1})) << time;
    EXPECT_EQ(n.touch, Touch::open);
    n.u.z = -1;
    EXPECT_TRUE(n.decide({0, 0, -1})) << time;
  }
  EXPECT_EQ(n.changes.closings, 3);
  n.decide({0, 0, 1});
  EXPECT_NE(n.touch, Touch::open);
}

TEST(DecideContact, sticks_again_once_and_is_smoothed_then) {
  OneNode n;
  ASSERT_TRUE(n.decide({6, 0, -10}));
  n.u = {-0.1, 0, 0};
  EXPECT_TRUE(n.decide({6, 0, -10}));
  EXPECT_EQ(n.changes.turns, 2);
  EXPECT_TRUE(n.held().smoothed(0));
  EXPECT_EQ(n.touch, Touch::slips) << "it has changed too often: friction is smoothed instead";
  EXPECT_FALSE(n.decide({6, 0, -10}));
  // One that was taken to slip from the start has a change left.
  OneNode fresh;
  fresh.touch = Touch::slips;
  fresh.direction = {1, 0, 0};
  fresh.u = {-0.1, 0, 0};
  EXPECT_TRUE(fresh.decide({6, 0, -10}));
  EXPECT_EQ(fresh.touch, Touch::sticks);
  EXPECT_EQ(length(fresh.u), 0);
}

TEST(DecideContact, counts_what_it_takes_to_stop_a_moving_node) {
  OneNode n;
  n.dynamic = true;
  n.velocity = {1, 0, 0};
  // The reaction is 10 N and holds 5; stopping 2 kg at 1 m/s in 0.1 s takes 20.
  EXPECT_TRUE(n.decide({0, 0, -10}));
  EXPECT_EQ(n.touch, Touch::slips);
  EXPECT_EQ(n.direction.x, 1);
}

}  // namespace
}  // namespace talus::solver::testing
