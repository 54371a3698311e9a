// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A step of the implicit solver: its clock and what it reports.
#include "solver/implicit/implicit_solver.hpp"

#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

TEST(ImplicitSolver, makes_steps_of_the_recipe_up_to_the_next_event) {
  SolveOptions o = options_of(Integrator::newmark);
  o.implicit.step = 0.01;
  const Scene scene = PartsBench::make(o);
  const SolverSettings settings = make_settings(o, scene.grid);
  ImplicitSolver<double, CpuDevice, PartsBench::Shape> solver(CpuDevice::make(), scene, settings.common,
                                                              settings.implicit, first_state(scene, settings.common));
  EXPECT_EQ(solver.clock().accelerated, 0);
  solver.set_next_event(0.015);
  const BatchReport first = solver.advance();
  EXPECT_EQ(first.stats.cuts, 0);
  EXPECT_GE(first.stats.newton, 1);
  const Clock clock = solver.clock();
  EXPECT_EQ(clock.step, 1);
  EXPECT_EQ(clock.accelerated, 1) << "the points know their acceleration";
  EXPECT_GT(clock.time, 0);
  EXPECT_LE(clock.time, 0.01);
  run_to(solver, 0.015);
  EXPECT_EQ(solver.clock().time, 0.015);
}

bool gives_up = false;

/// The lists of two states are the same, bit for bit.
void expect_same_points(const ParticleState& a, const ParticleState& b) {
  EXPECT_EQ(a.id, b.id);
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_EQ(a.offset[k], b.offset[k]);
    EXPECT_EQ(a.velocity[k], b.velocity[k]);
  }
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(a.elastic[k], b.elastic[k]);
}

/// A block in one of the implicit ways, whose steps are given up where gives_up says so.
class GivenUp {
 public:
  using Tested = ImplicitSolver<double, CpuDevice, PartsBench::Shape>;

  explicit GivenUp(Integrator integrator)
      : options_(options_of(integrator)),
        scene_(PartsBench::make(options_)),
        settings_(make_settings(options_, scene_.grid)) {
    settings_.implicit.give_up = [] { return gives_up; };
  }
  std::unique_ptr<Tested> begin_at(const SolverState& state) const {
    auto solver = std::make_unique<Tested>(CpuDevice::make(), scene_, settings_.common, settings_.implicit, state);
    solver->set_next_event(0.01);
    return solver;
  }
  SolverState start() const { return first_state(scene_, settings_.common); }

 private:
  SolveOptions options_;
  Scene scene_;
  SolverSettings settings_;
};

TEST(ImplicitSolver, keeps_nothing_of_a_step_that_is_given_up) {
  gives_up = true;
  for (const Integrator integrator : {Integrator::newmark, Integrator::quasi_static}) {
    SCOPED_TRACE(integrator == Integrator::newmark ? "newmark" : "quasi-static");
    const GivenUp run(integrator);
    const auto stopped = run.begin_at(run.start());
    const SolverState start = stopped->state();
    const BatchReport report = stopped->advance();
    EXPECT_TRUE(report.can_be_saved);
    EXPECT_EQ(report.stats.newton, 0);
    EXPECT_EQ(report.clock.time, 0);
    EXPECT_EQ(stopped->clock().step, 0);
    expect_same_points(stopped->state().points, start.points);
  }
}

TEST(ImplicitSolver, goes_on_from_a_step_that_was_given_up_as_if_it_had_never_begun_it) {
  const GivenUp run(Integrator::newmark);
  gives_up = true;
  const auto stopped = run.begin_at(run.start());
  stopped->advance();
  gives_up = false;
  const auto unbroken = run.begin_at(run.start()), resumed = run.begin_at(stopped->state());
  EXPECT_GE(unbroken->advance().stats.newton, 1);
  EXPECT_GE(resumed->advance().stats.newton, 1);
  EXPECT_GT(resumed->clock().time, 0);
  EXPECT_EQ(resumed->clock().time, unbroken->clock().time);
  expect_same_points(resumed->state().points, unbroken->state().points);
}

TEST(ImplicitSolver, counts_those_who_leave_once) {
  Domain domain = ground(24, 16, 10, 5, [](double, double) { return 0.0; });
  fill(domain, {20, 80, 50, 110, 0, 10});
  SolveOptions options;
  options.initial_velocity = {-20, 0, 0};
  options.integrator = Integrator::newmark;
  options.implicit.step = 0.05;
  const Scene scene = make_scene(domain, options);
  const auto implicit = make_solver(scene, options, On::cpu);
  implicit->set_next_event(10);
  BatchReport report;
  while (report.outflow_count == 0) report = implicit->advance();
  EXPECT_GT(report.outflow_volume, 0);
  const SolverState state = implicit->state();
  EXPECT_EQ(state.clock.outflow.count, 0);
  EXPECT_EQ(state.clock.outflow.volume, 0);
  // Explicit steps that take over lose no further point, nor do they where a checkpoint says otherwise.
  options.integrator = Integrator::explicit_;
  SolverState stale = state;
  stale.clock.outflow.count = report.outflow_count;
  for (const SolverState& from : {state, stale}) {
    const auto solver = resume_solver(scene, options, On::cpu, from);
    run_to(*solver, state.clock.time + 1e-9);
    EXPECT_EQ(solver->particle_count(), implicit->particle_count());
    EXPECT_NEAR(solver->energies().volume, implicit->energies().volume, 1e-9);
  }
}

}  // namespace
}  // namespace talus::solver::testing
