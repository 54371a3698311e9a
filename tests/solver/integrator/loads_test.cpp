// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/loads.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace talus::solver {
namespace {

TEST(Loads, grow_over_their_ramp) {
  const std::vector<Load> loads{{.force = {8, -4, 2}, .ramp = 4}, {.force = {0, 0, 6}, .ramp = 0}};
  const std::vector<double> volumes{2, 3};
  const auto at = [&](double time) { return load_densities(loads, volumes, time); };
  EXPECT_EQ(at(0)[0].x, 0);
  EXPECT_EQ(at(0)[1].z, 2);
  EXPECT_EQ(at(2)[0].x, 2);  // half of 8 N over 2 m3
  EXPECT_EQ(at(2)[0].y, -1);
  EXPECT_EQ(at(7)[0].z, 1);
  EXPECT_EQ(at(7)[1].z, 2);
  EXPECT_TRUE(load_densities(loads, {}, 3).empty());
}

TEST(Loads, without_a_ramp_jump_at_the_start) {
  const std::vector<Load> sudden{{.force = {6, 0, 0}, .ramp = 0}}, slow{{.force = {6, 0, 0}, .ramp = 4}};
  EXPECT_TRUE(loads_jump(sudden, {3}, 0));
  EXPECT_FALSE(loads_jump(sudden, {3}, 1));
  EXPECT_FALSE(loads_jump(slow, {3}, 0));
  EXPECT_FALSE(loads_jump(sudden, {}, 0)) << "it pulls at nothing";
}

}  // namespace
}  // namespace talus::solver
