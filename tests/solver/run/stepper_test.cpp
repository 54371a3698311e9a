// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of a run: from event to event, by whichever integrator.
#include "solver/run/stepper.hpp"

#include <gtest/gtest.h>

#include "solver/scene/make_solver.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

Domain column_of_sand() {
  Domain d = ground(16, 16, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 12, 4, 12, 0, 4});
  return d;
}

TEST(Stepper, meets_events_and_knows_its_step_over_the_cfl_step) {
  const Domain d = column_of_sand();
  for (const Integrator integrator : {Integrator::explicit_, Integrator::automatic}) {
    SolveOptions o;
    o.integrator = integrator;
    const Scene scene = make_scene(d, o);
    Stepper stepper(scene, o, CpuDevice::make());
    EXPECT_FALSE(stepper.begun());
    stepper.begin(first_state(scene, make_settings(o, scene.grid).common));
    EXPECT_TRUE(stepper.begun());
    BatchReport batch;
    while (batch.clock.alarms.halt != at_event) batch = stepper.advance(0.02);
    EXPECT_EQ(stepper.time(), 0.02);
    EXPECT_EQ(stepper.solver().clock().time, 0.02);
    EXPECT_GT(stepper.over_cfl(), 0);
    EXPECT_LE(stepper.over_cfl(), o.cfl * (1 + 1e-6));
  }
}

TEST(Stepper, chooses_no_implicit_steps_where_a_law_does_not_take_them) {
  const Domain d = column_of_sand();
  SolveOptions o;
  o.integrator = Integrator::automatic;
  for (const auto model : {MaterialModel::drucker_prager, MaterialModel::neo_hookean, MaterialModel::mu_of_i,
                           MaterialModel::herschel_bulkley}) {
    o.material.model = model;
    const Scene scene = make_scene(d, o);
    const Stepper stepper(scene, o, CpuDevice::make());
    EXPECT_EQ(stepper.chooses(), model == MaterialModel::drucker_prager || model == MaterialModel::neo_hookean);
  }
}

}  // namespace
}  // namespace talus::solver::testing
