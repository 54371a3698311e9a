// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How steps go by in batches, sort their points, end and fail; what every integrator has, and points that are added.
#include <numeric>

#include "solver/integrator/batch_solver.hpp"
#include "solver/integrator/column_contact.hpp"
#include "solver/integrator/device_state.hpp"
#include "solver/integrator/point_solver.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

// A signal waits for the end of a batch.
TEST(BatchSolver, takes_one_step_at_a_time_on_a_cpu) {
  Domain domain = filled(ground(12, 12, 10, 5, flat), {40, 80, 40, 80, 0, 5});
  for (const Integrator integrator : flow_integrators) {
    SolveOptions options = stepping_by(integrator);
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

TEST(DriftOnAGpu, follows_what_points_went_between_sorts) {
  const Drift now{.columns = 8, .layers = 5};
  EXPECT_EQ(drift_after(now, steps_worth_a_sort / 2, false).columns, 16) << "twice as far in the time wanted";
  EXPECT_EQ(drift_after(now, steps_worth_a_sort / 2, false).layers, 5) << "no layer asked for it";
  EXPECT_EQ(drift_after(now, steps_worth_a_sort / 2, true).layers, 10);
  EXPECT_EQ(drift_after(now, steps_worth_a_sort, true).layers, 5) << "as it should be";
  EXPECT_EQ(drift_after(now, 1, true).layers, most_drift.layers);
  EXPECT_EQ(drift_after(most_drift, 1000, false).columns, least_drift.columns) << "less is stored again";
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
    expect_near(taken, {force.x - left.x, force.y - left.y, force.z - left.z}, 1e-12);
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

/// A clock between two events, with a step behind it.
Clock after_a_step() {
  Clock clock;
  clock.control.longest = 0.25;
  clock.next_event = 10;
  clock.time = 0.25;
  clock.motion_maps.is_due = 1;  // of that step
  return clock;
}

/// Opens the next step, or none; returns what the host was given, a clock of no step where that was nothing.
Clock open_step(Clock& clock) {
  Clock room;
  OpenStep{&clock, &clock, &room}();
  return room;
}

TEST(OpenStep, opens_the_steps_of_a_batch_and_no_more) {
  Clock clock = after_a_step();
  clock.steps_ahead = 2;
  for (int n = 0; n < 4; ++n) open_step(clock);
  EXPECT_EQ(clock.step, 2);
  EXPECT_EQ(clock.time, 0.75);
  EXPECT_EQ(clock.steps_ahead, 0);
  EXPECT_EQ(clock.alarms.halt, running);
  EXPECT_EQ(clock.motion_maps.is_due, 0) << "the last step has recorded what it summed up";
}

TEST(OpenStep, gives_the_clock_to_the_host_where_it_opens_none) {
  Clock clock = after_a_step();
  clock.steps_ahead = 1;
  EXPECT_EQ(open_step(clock).step, 0);
  EXPECT_EQ(open_step(clock).step, 1) << "the last step is closed";
  clock.alarms.halt = wants_sort;
  clock.steps_ahead = 1;
  EXPECT_EQ(open_step(clock).step, 1) << "it had halted before";
}

TEST(OpenStep, takes_the_clock_from_elsewhere_as_a_batch_begins) {
  Clock lent = after_a_step(), clock, room;
  lent.steps_ahead = 1;
  OpenStep{&lent, &clock, &room}();
  EXPECT_EQ(clock.step, 1);
  EXPECT_EQ(lent.step, 0);
}

TEST(OpenStep, halts_at_an_event_whether_or_not_steps_are_left) {
  for (const int left : {0, 3}) {
    Clock clock = after_a_step();
    clock.steps_ahead = left;
    clock.time = clock.next_event;
    open_step(clock);
    EXPECT_EQ(clock.alarms.halt, at_event);
    EXPECT_EQ(clock.step, 0);
  }
}

TEST(OpenStep, leaves_a_batch_alone_that_has_halted) {
  Clock clock = after_a_step();
  clock.steps_ahead = 3;
  clock.alarms.halt = wants_sort;
  open_step(clock);
  EXPECT_EQ(clock.step, 0);
  EXPECT_EQ(clock.steps_ahead, 3);
}

TEST(OpenStep, halts_for_a_sort_or_a_failure_that_the_last_step_asked_for) {
  for (const int request : {wants_sort, failed}) {
    Clock clock = after_a_step();
    clock.alarms.request = request;
    open_step(clock);
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
  return to_string(faults_of<NumericalError>([&] { refuse_step(clock, 1e-4, stats, dynamic); }).at(0));
}

TEST(step_failure, names_step_time_residual_and_iterations) {
  StepStats stats;
  stats.newton = 30;
  stats.linear = 200;
  stats.residual = 0.02;
  const std::string text = said(stats, true);
  EXPECT_TRUE(test::holds(text, {"step 42", "t = 1.5 s", "0.0001 s", "0.02 of the forces", "30 Newton", "200 linear"}));
  EXPECT_NE(text.find("step_s"), std::string::npos) << text;
}

TEST(step_failure, statics_without_support_are_told_apart) {
  StepStats stats;
  stats.indefinite = true;
  EXPECT_NE(said(stats, false).find("singular or unstable"), std::string::npos);
  EXPECT_EQ(said(stats, true).find("singular or unstable"), std::string::npos);
}

/// An integrator that makes no step.
class StandingStill final : public PointSolver<double, CpuDevice, Quadratic> {
 public:
  StandingStill(const Scene& scene, const IntegratorSettings& settings, const SolverState& state)
      : PointSolver(CpuDevice::make(), scene, settings, state, settings.needs, {}) {
    fit(0);
  }
  BatchReport advance() override { return {}; }
  void add(const ParticleState&, double) override {}
  using PointSolver::full_base, PointSolver::layer_mass, PointSolver::set_walls;
  const double* columns() {
    measure_columns();
    return measures_.column_volumes();
  }
  WallNodes walls() const { return grid_.view().walls; }
};

struct Still {
  Scene scene;
  IntegratorSettings settings;
  SolverState start;

  Still() {
    Domain d = filled(ground(12, 10, 2.0, 0.5, [](double, double) { return 5.0; }), {8, 12, 6, 10, 0, 1.5});
    SolveOptions o;
    o.material.density = 1500;
    scene = make_scene(d, o);
    settings = make_settings(o, scene.grid).common;
    settings.walls = {{.axis = 0, .position = 7, .to = 1}};
    start = first_state(scene, settings);
  }
  StandingStill make() const { return {scene, settings, start}; }
};

TEST(PointSolver, keeps_particles_clock_and_maps_for_a_checkpoint) {
  Still still;
  still.start.clock.time = 3;
  still.start.maps.peak_speed[17] = 8;
  StandingStill solver = still.make();
  solver.set_next_event(4.5);
  const SolverState state = solver.state();
  EXPECT_EQ(state.clock.time, 3);
  EXPECT_EQ(state.clock.next_event, 4.5);
  EXPECT_EQ(solver.clock().next_event, 4.5);
  EXPECT_EQ(state.maps.peak_speed, still.start.maps.peak_speed);
  EXPECT_EQ(solver.particle_count(), static_cast<int>(still.scene.points.size()));
  EXPECT_EQ(std::accumulate(state.points.volume.begin(), state.points.volume.end(), 0.0), 24);
}

TEST(PointSolver, measures_the_whole_mass) {
  const Still still;
  StandingStill solver = still.make();
  EXPECT_NEAR(solver.energies().volume, 24, 1e-12);
  const std::vector<double> thickness = solver.thickness();
  EXPECT_NEAR(4 * std::accumulate(thickness.begin(), thickness.end(), 0.0), 24, 1e-12);
  EXPECT_EQ(solver.layer_mass(), 1500 * 0.5);
  EXPECT_EQ(solver.full_base(), Quadratic::edge_share * 1500 * 2 * 2 * 0.5);
}

TEST(PointSolver, measures_volumes_over_columns_where_densities_differ_alone) {
  Still still;
  EXPECT_EQ(still.make().columns(), nullptr);
  still.settings.materials.densities_differ = true;
  EXPECT_NE(still.make().columns(), nullptr);
}

TEST(PointSolver, lets_the_grid_meet_the_walls_of_a_time) {
  const Still still;
  StandingStill solver = still.make();
  EXPECT_EQ(solver.set_walls<double>(1.5).count, 0);
  EXPECT_EQ(solver.walls().west, -WallNodes::far);
  EXPECT_EQ(solver.set_walls<double>(0.5).count, 1);
  EXPECT_EQ(solver.walls().west, 3);  // 7 m, nodes at 1 m, 3 m, ...
}

TEST(PointSolver, lists_its_memory_by_owner) {
  const Still still;
  const MemoryShares shares = still.make().memory();
  ASSERT_GE(shares.size(), 3u);
  EXPECT_EQ(shares[0].first, "points");
  EXPECT_EQ(shares[1].first, "grid");
  EXPECT_EQ(shares[2].first, "maps and records");
  EXPECT_GE(shares[2].second, 4 * 120 * sizeof(double));
}

TEST(Inflow, sums_up_the_pulses_that_have_passed) {
  Inflow inflow;
  inflow.points.resize(5);
  for (std::size_t p = 0; p < 5; ++p) inflow.points.id[p] = static_cast<int>(10 + p);
  inflow.pulses = {{.time = 1, .first = 0, .count = 3, .volume = 2, .energy = 7, .momentum = {1, 0, 0}},
                   {.time = 2, .first = 3, .count = 2, .volume = 5, .energy = 1, .momentum = {2, 1, 0}}};
  EXPECT_EQ(inflow.points_in(0), 0u);
  EXPECT_EQ(inflow.points_in(1), 3u);
  EXPECT_EQ(inflow.points_in(2), 5u);
  EXPECT_EQ(inflow.volume(1), 2);
  EXPECT_EQ(inflow.volume(2), 7);
  EXPECT_EQ(inflow.energy(2), 8);
  EXPECT_EQ(inflow.momentum(2).x, 3);
  EXPECT_EQ(inflow.points_of(inflow.pulses[1]).id, (std::vector<int>{13, 14}));
}

class AddedPoints : public InEachPlace {};
TALUS_IN_EACH_PLACE(AddedPoints);

TEST_P(AddedPoints, are_behind_those_that_were_there_and_change_nothing_of_them) {
  Domain d = filled(ground(16, 16, 1.0, 1.0, flat), {4, 8, 4, 8, 0, 2});
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark}) {
    for (const Precision precision : {Precision::double_, Precision::single_}) {
      SolveOptions o = stepping_by(integrator);
      o.precision = precision;
      const SceneRun run(d, o, GetParam(), 0.02);
      const ParticleState before = run.solver->state().points;
      const Energies energies = run.solver->energies();
      ParticleState more = run.scene.points;  // elsewhere, and often enough that arrays must grow
      for (int& i : more.cell[0]) i += 5;
      for (int time = 0; time < 5; ++time) {
        for (int& id : more.id) id += static_cast<int>(run.scene.points.size());
        run.solver->add(more, 1.0);
      }
      EXPECT_EQ(run.solver->particle_count(), static_cast<int>(6 * run.scene.points.size()));
      EXPECT_NEAR(run.solver->energies().volume, 6 * energies.volume, 1e-6);
      const ParticleState after = run.solver->state().points;
      std::vector<std::size_t> place(after.size());
      for (std::size_t p = 0; p < after.size(); ++p) place[static_cast<std::size_t>(after.id[p])] = p;
      for (std::size_t p = 0; p < before.size(); ++p) {
        const std::size_t q = place[static_cast<std::size_t>(before.id[p])];
        EXPECT_EQ(after.velocity[2][q], before.velocity[2][p]);
        EXPECT_EQ(after.elastic[2][q], before.elastic[2][p]);
        EXPECT_EQ(after.offset[2][q], before.offset[2][p]);
      }
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
