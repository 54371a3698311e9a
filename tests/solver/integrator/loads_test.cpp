// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/integrator/loads.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace talus::solver {
namespace {

TEST(Loads, grow_over_their_ramp_and_end) {
  const std::vector<LoadOptions> loads{{.force = {8, -4, 2}, .ramp = 4, .from = 1, .to = 10},
                                       {.force = {0, 0, 6}, .ramp = 0, .from = 0, .to = 2}};
  const std::vector<double> volumes{2, 3};
  const auto at = [&](double time) { return load_densities(loads, volumes, time, time); };
  EXPECT_EQ(at(0)[0].x, 0);
  EXPECT_EQ(at(0)[1].z, 2);
  EXPECT_EQ(at(3)[0].x, 2);  // half of 8 N over 2 m3
  EXPECT_EQ(at(3)[0].y, -1);
  EXPECT_EQ(at(3)[1].z, 0);
  EXPECT_EQ(at(7)[0].z, 1);
  EXPECT_EQ(at(10)[0].x, 0);
  EXPECT_TRUE(load_densities(loads, {}, 3, 3).empty());
}

TEST(Loads, that_begin_or_end_with_a_step_are_none_of_that_step_and_jump) {
  const std::vector<LoadOptions> loads{{.force = {6, 0, 0}, .ramp = 0, .from = 1, .to = 2},
                                       {.force = {6, 0, 0}, .ramp = 4, .from = 3, .to = 9}};
  const std::vector<double> volumes{3, 2};
  EXPECT_EQ(load_densities(loads, volumes, 0.5, 1)[0].x, 0);
  EXPECT_EQ(load_densities(loads, volumes, 1, 1.5)[0].x, 2);
  EXPECT_EQ(load_densities(loads, volumes, 1.5, 2)[0].x, 2);
  EXPECT_EQ(load_densities(loads, volumes, 2, 2.5)[0].x, 0);
  EXPECT_EQ(load_densities(loads, volumes, 3, 5)[1].x, 1.5);  // half of its ramp at the end of the step
  for (const auto& [time, jumps] : {std::pair{0.5, false}, {1.0, true}, {2.0, true}, {3.0, false}, {9.0, true}})
    EXPECT_EQ(loads_jump(loads, volumes, time), jumps) << time;
  EXPECT_FALSE(loads_jump(loads, {}, 1)) << "they pull at nothing";
}

}  // namespace
}  // namespace talus::solver
