// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The state of conjugate gradients: when a loop halts, and what a node's step does.
#include "solver/linear/krylov/cg_kernels.hpp"

#include <gtest/gtest.h>

namespace talus::testing {
namespace {

TEST(CgState, halts_at_once_without_a_right_hand_side) {
  CgState state;
  state.begin(0);
  EXPECT_EQ(state.halt, CgState::converged);
  CgState nan;
  nan.begin(std::nan(""));
  EXPECT_EQ(nan.halt, CgState::spent);
}

TEST(CgState, halts_where_the_residual_is_small_enough_or_iterations_run_out) {
  CgState state;
  state.tolerance = 1e-3;
  state.most = 3;
  state.begin(4);
  state.take_residual(1);
  EXPECT_EQ(state.halt, CgState::no);
  CgState near = state;
  near.take_residual(4e-6);
  EXPECT_EQ(near.halt, CgState::converged);
  state.take_residual(1);
  state.take_residual(1);
  EXPECT_EQ(state.halt, CgState::spent);
  EXPECT_EQ(state.iterations, 3);
}

TEST(CgState, halts_where_the_curvature_is_not_positive) {
  CgState state;
  state.begin(1);
  detail::FinishCurvature finish{&state};
  const double negative = -1, positive = 1;
  finish(&negative);
  EXPECT_EQ(state.halt, CgState::indefinite);
  finish(&positive);
  EXPECT_EQ(state.curvature, -1) << "what comes after the end changes nothing";
}

TEST(CgState, begins_with_the_first_direction_as_it_is) {
  CgState state;
  state.begin(1);
  state.take_angle(2);
  EXPECT_EQ(state.turn, 0);
  state.most = 10;
  state.take_residual(0.5);
  state.take_angle(1);
  EXPECT_EQ(state.turn, 0.5);
}

TEST(StepAlong, moves_the_solution_and_takes_from_the_residual) {
  CgState state;
  state.angle = 2;
  state.curvature = 4;
  const Vec3<double> p{1, 0, 0}, ap{2, 2, 0};
  Vec3<double> x{1, 1, 1}, r{3, 0, 4};
  EXPECT_DOUBLE_EQ((detail::StepAlong{&state, &p, &ap, &x, &r}(0)), 4 + 1 + 16);
  EXPECT_EQ(x.x, 1.5);
  EXPECT_EQ(r.y, -1);
}

}  // namespace
}  // namespace talus::testing
