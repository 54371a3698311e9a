// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What is said of a step that no halving could bring to convergence.
#include "solver/integrator/step_failure.hpp"

#include <gtest/gtest.h>

#include <string>

#include "common/error.hpp"

namespace talus::solver {
namespace {

std::string said(const StepStats& stats, bool dynamic) {
  Clock clock;
  clock.step = 41;
  clock.time = 1.5;
  try {
    refuse_step(clock, 1e-4, stats, dynamic);
  } catch (const NumericalError& error) {
    return to_string(error.faults().front());
  }
}

TEST(step_failure, names_step_time_residual_and_iterations) {
  StepStats stats;
  stats.newton = 30;
  stats.linear = 200;
  stats.residual = 0.02;
  const std::string text = said(stats, true);
  for (const char* words : {"step 42", "t = 1.5 s", "0.0001 s", "0.02 of the forces", "30 Newton", "200 linear"})
    EXPECT_NE(text.find(words), std::string::npos) << words << " in: " << text;
  EXPECT_NE(text.find("step_s"), std::string::npos) << text;
}

TEST(step_failure, statics_without_support_are_told_apart) {
  StepStats stats;
  stats.indefinite = true;
  EXPECT_NE(said(stats, false).find("singular or unstable"), std::string::npos);
  EXPECT_EQ(said(stats, true).find("singular or unstable"), std::string::npos);
}

}  // namespace
}  // namespace talus::solver
