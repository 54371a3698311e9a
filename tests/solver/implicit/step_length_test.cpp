// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What goes from step to step: their length, when iterations are given up, and the slip over which friction grows.
#include "solver/implicit/step_length.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/implicit/friction_smoothing.hpp"
#include "solver/implicit/stall.hpp"

namespace talus::solver::testing {
namespace {

constexpr int most_iterations = 30, few = 4;

TEST(StepLength, never_steps_over_an_event) {
  const StepLength length(1, most_iterations);
  EXPECT_EQ(length.next(10), 1);
  EXPECT_EQ(length.next(1.5), 0.75) << "two even steps rather than a full one and a sliver";
  EXPECT_EQ(length.next(0.5), 0.5);
  EXPECT_EQ(length.next(1 + 1e-12), 1 + 1e-12);
}

TEST(StepLength, a_short_step_before_an_event_leaves_the_plan_as_it_was) {
  StepLength length(1, most_iterations);
  length.accept(0.25, few, 0.1);
  EXPECT_EQ(length.next(10), 1);
}

TEST(StepLength, grows_with_few_iterations_stays_with_some_and_shrinks_with_many) {
  StepLength length(1, most_iterations);
  EXPECT_EQ(length.refuse(1, 0), 0.5);
  EXPECT_EQ(length.refuse(0.5, 0), 0.25);
  length.accept(0.25, 12, 0);
  EXPECT_EQ(length.next(10), 0.25);
  length.accept(0.25, few, 0);
  EXPECT_EQ(length.next(10), 0.375);
  length.accept(0.375, 25, 0);
  EXPECT_EQ(length.next(10), 0.7 * 0.375);
}

TEST(StepLength, of_one_linear_solve_grows_after_each) {
  StepLength length(1, 1);
  length.refuse(1, 0);
  length.accept(0.5, 1, 0);
  EXPECT_EQ(length.next(10), 0.75);
}

TEST(StepLength, foresees_the_way_of_the_farthest_point) {
  StepLength length(1, most_iterations);
  EXPECT_NEAR(length.refuse(1, 4), 0.2, 1e-12) << "0.8 of the way, not half of the step";
  length.accept(0.2, few, 0.9);
  EXPECT_NEAR(length.next(10), 0.2 * 0.8 / 0.9, 1e-12);
}

/// Attempts at steps of which those longer than `limit(time)` fail.
struct Attempts {
  int accepted = 0, failed = 0;
  double share = 0;  ///< of the limit that the steps took, in the mean
};
template <class Limit>
Attempts attempts(const Limit& limit, bool of_motion = false) {
  StepLength length(1, most_iterations);
  Attempts count;
  double time = 0;
  while (count.accepted < 2000) {
    double step = length.next(1e9);
    const auto motion = [&] { return of_motion ? step / limit(time) : 0.0; };
    while (step > limit(time)) {
      ++count.failed;
      step = length.refuse(step, motion());
    }
    length.accept(step, few, motion());
    ++count.accepted;
    count.share += step / limit(time);
    time += step;
  }
  count.share /= count.accepted;
  return count;
}

TEST(StepLength, wastes_less_than_a_twentieth_of_its_attempts_on_a_limit_that_it_does_not_know) {
  for (const double limit : {0.9, 0.5, 0.037, 0.002}) {
    const Attempts still = attempts([&](double) { return limit; });
    EXPECT_LT(still.failed, 0.05 * still.accepted) << limit;
    EXPECT_GT(still.share, 0.7) << limit;
  }
  const Attempts moving = attempts([](double time) { return 0.02 * std::exp(std::sin(0.2 * time)); });
  EXPECT_LT(moving.failed, 0.05 * moving.accepted);
  EXPECT_GT(moving.share, 0.6);
  const Attempts far = attempts([](double time) { return 0.1 / (1 + 0.1 * time); }, true);
  EXPECT_LT(far.failed, 0.01 * far.accepted) << "a limit on the way is foreseen";
}

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
