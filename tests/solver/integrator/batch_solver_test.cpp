// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How steps begin, go by in batches, sort their points, end, and fail.
#include "solver/integrator/batch_solver.hpp"

#include "solver/integrator/at_home.hpp"
#include "solver/integrator/column_contact.hpp"
#include "solver/integrator/ends_of_steps.hpp"
#include "solver/integrator/sort_intervals.hpp"
#include "solver/integrator/step_failure.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

// A signal waits for the end of a batch.
TEST(BatchSolver, takes_one_step_at_a_time_on_a_cpu) {
  Domain domain = ground(12, 12, 10, 5, [](double, double) { return 0.0; });
  fill(domain, {40, 80, 40, 80, 0, 5});
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit}) {
    SolveOptions options;
    options.integrator = integrator;
    const auto solver = make_solver(make_scene(domain, options), options, On::cpu);
    solver->set_next_event(10);
    for (int step = 1; step <= 3; ++step) {
      const BatchReport report = solver->advance();
      EXPECT_EQ(report.clock.step, step);
      EXPECT_TRUE(report.can_be_saved);
    }
  }
}

TEST(SortsOnAGpu, are_frequent_only_for_many_points_with_wide_stencils) {
  EXPECT_GT(steps_between_sorts_on_gpu<Quadratic>(1000), steps_between_sorts_on_gpu<Quadratic>(1000000));
  EXPECT_EQ(steps_between_sorts_on_gpu<Linear>(1000), steps_between_sorts_on_gpu<Linear>(1000000));
}

TEST(DriftBetweenSorts, is_wide_where_neither_order_nor_colours_of_blocks_bound_it) {
  EXPECT_EQ(drift_between_sorts<GpuDevice>(true).columns, 1);
  EXPECT_EQ(drift_between_sorts<CpuDevice>(false).columns, 1);
  EXPECT_GT(drift_between_sorts<GpuDevice>(false).columns, 1);
}

TEST(NodeStep, damping_takes_a_share_of_every_component_against_the_velocity) {
  const Vec3<double> force{10, -4, 6}, velocity{1, 2, 0}, left = damped(force, velocity, 0.25);
  EXPECT_DOUBLE_EQ(left.x, 7.5) << "along the velocity";
  EXPECT_DOUBLE_EQ(left.y, -5) << "against it";
  EXPECT_DOUBLE_EQ(left.z, 6) << "at rest";
}

TEST(NodeStep, what_damping_took_is_known_from_what_it_left) {
  const Vec3<double> velocity{1, -2, 0};
  for (const Vec3<double>& force : {Vec3<double>{10, -4, 6}, Vec3<double>{-3, 5, -1}, Vec3<double>{}}) {
    const Vec3<double> left = damped(force, velocity, 0.3), taken = taken_by_damping(left, velocity, 0.3);
    EXPECT_NEAR(taken.x, force.x - left.x, 1e-12);
    EXPECT_NEAR(taken.y, force.y - left.y, 1e-12);
    EXPECT_NEAR(taken.z, force.z - left.z, 1e-12);
  }
}

TEST(NodeStep, losses_tell_friction_from_what_presses) {
  ColumnLosses losses;
  losses.take(GivenImpulses<double>{{-2, 0, 5}, {1, 0, 0}}, Vec3<double>{3, 0, 0.5}, Vec3<double>{0, 0, 1});
  EXPECT_DOUBLE_EQ(losses.contact, 3 - 2.5);
  EXPECT_DOUBLE_EQ(losses.friction, 6);
  EXPECT_DOUBLE_EQ(losses.pressed, 5);
  EXPECT_DOUBLE_EQ(losses.reaction[0], -1);
  losses.pass_on(2.0, Vec3<double>{1, 0, 0}, Vec3<double>{3, 0, 0});
  EXPECT_DOUBLE_EQ(losses.transfer, 8) << "the kinetic energy that the node gained";
  Clock clock;
  losses.add_to(clock);
  EXPECT_DOUBLE_EQ(clock.budget.friction_loss, 6);
  EXPECT_DOUBLE_EQ(clock.budget.transfer_loss, 8);
}

TEST(BeginStep, clears_every_node_and_opens_the_step_once) {
  Clock clock;
  clock.control.longest = 0.25;
  clock.next_event = 10;
  std::vector<Vec4<double>> nodes(5, {1, 2, 3, 4}), forces = nodes;
  const BeginStep<double> begin{&clock, nodes.data(), forces.data(), 4, true};
  for (int n = 0; n < 6; ++n) begin(n);  // threads beyond the nodes do nothing
  EXPECT_EQ(clock.step, 1);
  EXPECT_EQ(clock.time, 0.25);
  for (std::size_t n = 0; n < 5; ++n) {
    EXPECT_EQ(nodes[n].w, n < 4 ? 0 : 1);
    EXPECT_EQ(forces[n].z, n < 4 ? 0 : 4);
  }
}

TEST(BeginStep, leaves_the_clock_alone_where_it_does_not_open_the_step) {
  Clock clock;
  clock.next_event = 10;
  std::vector<Vec4<double>> nodes(1, {1, 2, 3, 4});
  BeginStep<double>{&clock, nodes.data(), nullptr, 1, false}(0);
  EXPECT_EQ(clock.step, 0);
  EXPECT_EQ(nodes[0].w, 0);
}

/// A clock between two events, with a step behind it.
Clock after_a_step() {
  Clock clock;
  clock.control.longest = 0.25;
  clock.next_event = 10;
  clock.time = 0.25;
  clock.motion_maps.is_due = 1;  // of that step
  return clock;
}

TEST(CloseBatch, goes_on_where_nothing_is_due) {
  Clock clock = after_a_step();
  CloseBatch{&clock}(0);
  EXPECT_EQ(clock.alarms.halt, running);
  EXPECT_EQ(clock.motion_maps.is_due, 0) << "the step has recorded what it summed up";
}

TEST(CloseBatch, halts_at_an_event_and_lets_motion_be_recorded) {
  Clock clock = after_a_step();
  clock.time = clock.next_event;
  CloseBatch{&clock}(0);
  EXPECT_EQ(clock.alarms.halt, at_event);
  EXPECT_EQ(clock.motion_maps.is_due, 1);
}

TEST(CloseBatch, records_no_motion_again_where_a_step_has_halted_at_the_event) {
  Clock clock = after_a_step();
  clock.time = clock.next_event;
  clock.begin_step();
  ASSERT_EQ(clock.alarms.halt, at_event);
  ASSERT_EQ(clock.motion_maps.is_due, 1) << "the kernels of that step sum it up";
  CloseBatch{&clock}(0);
  EXPECT_EQ(clock.alarms.halt, at_event);
  EXPECT_EQ(clock.motion_maps.is_due, 0);
}

TEST(CloseBatch, halts_for_a_sort_or_a_failure_that_the_last_step_asked_for) {
  for (const int request : {wants_sort, failed}) {
    Clock clock = after_a_step();
    clock.alarms.request = request;
    CloseBatch{&clock}(0);
    EXPECT_EQ(clock.alarms.halt, request);
  }
}

TEST(AtHome, gives_back_the_keys_and_the_order_of_the_sort) {
  constexpr int columns = 23, rows = 9;
  SolverState state;
  for (int octant = 0; octant < 8; ++octant)
    for (const int k : {0, 7, 300})
      for (const int i : {0, 4, 22})
        state.homes.push_back(static_cast<std::int64_t>(home_key(blocks_across(columns), i, 8 - i % 5, k, octant)));
  std::ranges::sort(state.homes);
  state.points.resize(state.homes.size());
  for (std::size_t p = 0; p < state.points.size(); ++p) {
    state.points.id[p] = static_cast<int>(p);
    state.points.cell[0][p] = p % 3 == 0 ? -1 : 11;  // wherever they have gone
    state.points.velocity[2][p] = 0.5 * static_cast<double>(p);
  }

  const ParticleState home = at_home(state, columns);
  EXPECT_EQ(home.velocity[2], state.points.velocity[2]);
  const CpuDevice device = CpuDevice::make();
  Particles<double, CpuDevice> points(device, {});
  points.upload(home);
  ParticleOrder<double, CpuDevice> order(device, columns, rows, {});
  order.sort(points, 0);
  const std::vector<std::uint64_t> keys = order.homes();
  EXPECT_TRUE(std::equal(keys.begin(), keys.end(), state.homes.begin(), state.homes.end(),
                         [](std::uint64_t a, std::int64_t b) { return a == static_cast<std::uint64_t>(b); }));
  EXPECT_EQ(points.download().id, state.points.id);
}

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
}  // namespace talus::solver::testing
