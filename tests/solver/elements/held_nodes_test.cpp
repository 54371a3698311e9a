// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a node has on the diagonal of the system (T19).
#include "solver/elements/held_nodes.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

struct OneHeldNode {
  double mass = 2;
  Sym3<double> freed{1, 1, 1, 0, 0, 0}, stiffness{1, 2, 3, 0.5, 0, 0}, tangent{10, 20, 30, 1, 2, 3};
  HeldNodes view() const { return {.count = 1, .mass = &mass, .freed = &freed, .inertia = 5, .stiffness = &stiffness}; }
};

TEST(HeldNodes, add_mass_and_stiffness_to_the_tangent) {
  const OneHeldNode n;
  const Sym3<double> own = own_block(n.view(), n.tangent, 0);
  EXPECT_EQ(own.xx, 10 + 10 + 1);
  EXPECT_EQ(own.zz, 30 + 10 + 3);
  EXPECT_EQ(own.xy, 1.5);
  const Sym3<double> free = held_block(n.view(), n.tangent, 0);
  EXPECT_EQ(free.xx, own.xx);
  EXPECT_EQ(free.xz, own.xz);
}

TEST(HeldNodes, are_the_identity_where_they_are_held) {
  OneHeldNode n;
  n.freed = {};
  const Sym3<double> held = held_block(n.view(), n.tangent, 0);
  EXPECT_EQ(held.xx, 1);
  EXPECT_EQ(held.yy, 1);
  EXPECT_EQ(held.xy, 0);
}

TEST(HeldNodes, project_the_block_on_free_directions) {
  OneHeldNode n;
  n.freed = {0.36, 0.64, 1, 0.48, 0, 0};  // all but (0.8, -0.6, 0)
  const Sym3<double> held = held_block(n.view(), n.tangent, 0);
  const Vec3<double> fixed{0.8, -0.6, 0}, free{0.6, 0.8, 0};
  EXPECT_NEAR(dot(fixed, held * fixed), 1, 1e-14);
  EXPECT_NEAR(dot(free, held * fixed), 0, 1e-14);
  EXPECT_NEAR(dot(free, held * free), dot(free, own_block(n.view(), n.tangent, 0) * free), 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
