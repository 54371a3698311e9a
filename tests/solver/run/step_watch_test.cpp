// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Steps that do not advance end the run; steps that have collapsed are said.
#include "solver/run/step_watch.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "common/stage/stage.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

Domain watched_block() {
  Domain d = ground(16, 16, 1.0, 0.5, [](double, double) { return 0.0; });
  fill(d, {6, 10, 6, 10, 0, 2});
  return d;
}

/// A batch of explicit steps that ended with this rate [1/s] and this speed [m/s].
BatchReport batch_at(double time, float rate, float speed) {
  BatchReport batch;
  batch.clock.time = time;
  batch.clock.step = 17;
  batch.clock.control.courant = 0.5;
  batch.clock.control.longest = 1;
  atomic_max_positive(&batch.clock.control.rate_bits, rate);
  atomic_max_positive(&batch.clock.control.speed_bits, speed);
  return batch;
}

Fault fault_of_step(StepWatch& watch, const BatchReport& batch) {
  try {
    watch.look(batch);
  } catch (const NumericalError& error) {
    return error.faults().front();
  }
  return {};
}

class WatchedSteps : public ::testing::Test {
 protected:
  Scene scene_ = make_scene(watched_block(), {});
  SolveOptions options_;
};

TEST_F(WatchedSteps, that_advance_go_on) {
  StepWatch watch(scene_, options_);
  EXPECT_EQ(fault_of_step(watch, batch_at(0, 100, 0)).what, "");
  EXPECT_EQ(fault_of_step(watch, batch_at(59.99, 100, 30)).what, "");
  // The last steps to an event may be as short as rounding leaves them.
  BatchReport sliver = batch_at(10, 100, 3);
  sliver.clock.step_size = 1e-15;
  EXPECT_EQ(fault_of_step(watch, sliver).what, "");
}

TEST_F(WatchedSteps, whose_waves_are_too_fast_end_the_run_and_name_the_modulus) {
  options_.material.youngs_modulus = 1e300;
  StepWatch watch(scene_, options_);
  const Fault fault = fault_of_step(watch, batch_at(0, std::numeric_limits<float>::infinity(), 0));
  EXPECT_NE(fault.what.find("step 17"), std::string::npos) << fault.what;
  EXPECT_NE(fault.what.find("60 s"), std::string::npos) << fault.what;
  EXPECT_NE(fault.why.find("youngs_modulus_Pa = 1e+300"), std::string::npos) << fault.why;
  EXPECT_NE(fault.mend.find("youngs_modulus_Pa"), std::string::npos) << fault.mend;
  options_.material.youngs_modulus = 1e28;  // a step of 1e-13 s, which is no zero
  StepWatch stiff(scene_, options_);
  EXPECT_NE(fault_of_step(stiff, batch_at(1e-9, 5e12F, 0)).what, "");
}

TEST_F(WatchedSteps, that_a_point_makes_too_short_end_the_run_and_name_its_speed) {
  StepWatch watch(scene_, options_);
  const Fault fault = fault_of_step(watch, batch_at(2, 1e13F, 9e5F));
  EXPECT_NE(fault.why.find("9e+05 m/s"), std::string::npos) << fault.why;
  EXPECT_NE(fault.mend.find("cfl (now 0.5)"), std::string::npos) << fault.mend;
}

TEST_F(WatchedSteps, that_are_implicit_and_too_short_end_the_run) {
  StepWatch watch(scene_, options_);
  BatchReport batch = batch_at(2, 100, 3);
  batch.stats.newton = 3;
  batch.clock.step_size = 1e-12;
  EXPECT_NE(fault_of_step(watch, batch).mend.find("step_s"), std::string::npos);
  batch.clock.alarms.halt = at_event;  // cut by an event, not by need
  EXPECT_EQ(fault_of_step(watch, batch).what, "");
}

TEST_F(WatchedSteps, that_have_collapsed_are_said_once) {
  StepWatch watch(scene_, options_);
  EXPECT_NEAR(watch.first_step(), 0.5 / (std::sqrt(1.2e7 / 2000) * std::sqrt(6.0)), 1e-9) << "two rows and a layer";
  ::testing::internal::CaptureStderr();
  const auto rate = static_cast<float>(0.5 / watch.first_step());
  watch.look(batch_at(3, 40 * rate, 10));
  EXPECT_EQ(::testing::internal::GetCapturedStderr().find("steps have fallen"), std::string::npos);
  ::testing::internal::CaptureStderr();
  watch.look(batch_at(3, 60 * rate, 2500));
  const std::string said = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find("steps have fallen"), std::string::npos) << said;
  EXPECT_NE(said.find("2.5e+03 m/s"), std::string::npos) << said;
  ::testing::internal::CaptureStderr();
  watch.look(batch_at(3, 60 * rate, 2500));
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
}

}  // namespace
}  // namespace talus::solver::testing
