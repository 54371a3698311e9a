// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The internal force of particles, a step of the implicit solver, and steps with contact and of flowing sand.
#include <numeric>

#include "solver/implicit/implicit_solver.hpp"
#include "solver/implicit/tangent_system.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/implicit_scenes.hpp"
#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

using Stresses = ParticleStresses<double, CpuDevice, PartsBench::Shape>;

/// The forces [N] of the bench's particles for a displacement of its nodes [m].
std::vector<Vec3<double>> forces(PartsBench& bench, const std::vector<Vec3<double>>& u) {
  const auto parts = bench.parts();
  Buffer<double, CpuDevice> mass(bench.device);
  mass.upload(std::vector<double>(u.size(), 1e6));  // so that no node is light, and none on springs
  Stresses stresses(parts, mass);
  stresses.group();
  stresses.begin(0.01);
  NodeVector<CpuDevice> moved(bench.device), sums(bench.device);
  moved.upload(u);
  sums.upload(std::vector<Vec3<double>>(u.size()));
  stresses.measure(moved, sums, true, false);
  return sums.download();
}

TEST(ParticleStresses, are_none_where_the_body_moves_as_a_whole) {
  PartsBench bench(options_of(Integrator::newmark));
  const auto count = static_cast<std::size_t>(bench.grid.nodes());
  for (const Vec3<double>& f : forces(bench, std::vector<Vec3<double>>(count, {0.1, -0.2, 0.3})))
    EXPECT_NEAR(length(f), 0, 1e-8);  // rounding of strains at 1e-16 times a stiffness of 1e6 Pa, some cells
}

TEST(ParticleStresses, balance_one_another_under_any_strain) {
  PartsBench bench(options_of(Integrator::newmark));
  std::vector<Vec3<double>> u(static_cast<std::size_t>(bench.grid.nodes()));
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double angle = static_cast<double>(n);
    u[n] = {0.01 * std::sin(angle), 0.01 * std::cos(2 * angle), 0};
  }
  Vec3<double> sum{};
  double size = 0;
  for (const Vec3<double>& f : forces(bench, u)) {
    sum += f;
    size += length(f);
  }
  EXPECT_GT(size, 1e3);
  EXPECT_LT(length(sum), 1e-12 * size);
}

TEST(ParticleStresses, round_tangents_only_where_newton_corrects_them) {
  ImplicitControls c;
  EXPECT_TRUE(Stresses::rounds(c));
  c.newton_iterations = 1;
  EXPECT_FALSE(Stresses::rounds(c));
  c.newton_iterations = 30;
  c.linear_solver = LinearSolver::cholesky;
  EXPECT_FALSE(Stresses::rounds(c));
}

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
  SolveOptions options = stepping_by(Integrator::newmark);
  options.initial_velocity = {-20, 0, 0};
  options.implicit.step = 0.05;
  const Scene scene = make_scene(filled(ground(24, 16, 10, 5, flat), {20, 80, 50, 110, 0, 10}), options);
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

class ImplicitContact : public InEachPlace {};
TALUS_IN_EACH_PLACE(ImplicitContact);

TEST_P(ImplicitContact, holds_a_node_once_where_a_roller_meets_the_ground) {
  SolveOptions o = column_options();
  o.base.law = FrictionLaw::coulomb;
  o.walls.push_back({Axis::z, 0, Side::above});
  o.material.youngs_modulus = 1e6;
  o.implicit.step = 0.5;
  const auto solver = make_solver(make_scene(column(6, 1), o), o, GetParam());
  EXPECT_LE(steps_to(*solver, 1.0), 12);
  EXPECT_EQ(solver->clock().step, 2);
}

TEST_P(ImplicitContact, tells_a_body_without_support_from_equilibrium) {
  Domain d = filled(ground(12, 12, 1.0, 1.0, flat), {4, 7, 4, 7, 3, 6});
  SolveOptions o = stepping_by(Integrator::quasi_static);
  o.material.model = MaterialModel::hencky;
  o.mapping = Mapping::cartesian;
  o.implicit.step_cuts = 1;
  o.implicit.linear_iterations = 500;
  const auto solver = make_solver(make_scene(d, o), o, GetParam());
  solver->set_next_event(1);
  const std::string fault = test::fault_of<NumericalError>([&] { solver->advance(); });
  EXPECT_NE(fault.find("Hold"), std::string::npos) << "a floating body: " << fault;
}

TEST_P(ImplicitContact, meets_an_indefinite_tangent_and_says_so) {
  // A slender column under twenty times its buckling load: its tangent is indefinite before the points have moved.
  for (const auto linear_solver : {LinearSolver::pcg, LinearSolver::cholesky}) {
    SolveOptions o = elastic_options(1e6, Integrator::newmark);
    o.mapping = Mapping::cartesian;
    o.material.poisson_ratio = 0;
    o.base.law = FrictionLaw::stick;
    o.gravity = {0.01, 0, 0};
    o.loads.push_back({{3, 3, 5, 5, 15, 16}, {0, 0, -2e6}, 0.0});
    o.implicit.step = 1.0;
    o.implicit.linear_solver = linear_solver;
    o.implicit.forcing = Forcing::fixed;  // else the iterations end before they have met the direction
    const SceneRun run(filled(ground(8, 8, 1.0, 1.0, flat), {3, 5, 3, 5, 0, 16}), o, GetParam());
    bool indefinite = false;
    run_to(*run.solver, 1, [&](const BatchReport& batch) { indefinite = indefinite || batch.stats.indefinite; });
    EXPECT_TRUE(indefinite);
    const Centre c = run.now();
    EXPECT_TRUE(std::isfinite(c.x) && std::isfinite(c.z));
    EXPECT_LT(c.z, 8);
  }
}

TEST_P(ImplicitContact, carries_a_single_point_and_nodes_without_mass) {
  // Alone in its cells, at a node (splines leave layers without weight) and beside one: it falls as the parabola says.
  for (const double x : {5.0, 5.37}) {
    for (const auto shape : {ShapeKind::linear, ShapeKind::quadratic, ShapeKind::gimp}) {
      for (const auto integrator : {Integrator::newmark, Integrator::explicit_}) {
        Domain d = filled(ground(12, 12, 1.0, 1.0, flat), {x - 0.25, x + 0.25, 5, 5.5, 6, 6.5});
        ASSERT_EQ(d.points.x.size(), 1U);
        SolveOptions o = stepping_by(integrator);
        o.material.model = MaterialModel::hencky;
        o.shape = shape;
        o.mapping = Mapping::cartesian;
        o.implicit.step = 0.05;
        o.implicit.newton_tolerance = 1e-12;
        const SceneRun run(d, o, GetParam());
        const Centre c = run.at(0.5);
        EXPECT_NEAR(c.speed, 9.81 * 0.5, 1e-9);
        // Explicit positions are half a step of its speed ahead.
        const double ahead = integrator == Integrator::explicit_ ? 9.81 * 0.5 * run.solver->clock().step_size : 0;
        EXPECT_NEAR(run.first.z - c.z, 0.5 * 9.81 * 0.25, 1e-9 + ahead);
      }
    }
  }
}

TEST_P(ImplicitContact, turns_on_curved_ground_with_one_solve_a_step) {
  // Released on the flank of a channel, a slab slides across it as it comes down. The paper's single solve must not
  // take friction for what holds a node to the direction it came in: it did, and lost a third of the energy.
  Domain d = ground(40, 24, 1.0, 1.0, [](double x, double y) { return 60 - 0.5 * x + 0.04 * (y - 12) * (y - 12); });
  fill(d, {4, 8, 3, 7, 0, 2});
  SolveOptions o;
  o.shape = ShapeKind::linear;
  o.transfer = Transfer::flip;
  o.transfer_time = 1e30;
  o.stress_update = StressUpdate::modified;
  o.material.model = MaterialModel::drucker_prager;
  o.material.youngs_modulus = 1e6;
  o.base.friction_angle = 15;
  const Scene scene = make_scene(d, o);
  const auto way = [&](const SolveOptions& options) {
    const auto solver = make_solver(scene, options, GetParam());
    const Centre start = centre(*solver, scene);
    run_to(*solver, 2.5);
    const Centre end = centre(*solver, scene);
    return std::array<double, 2>{end.x - start.x, end.y - start.y};
  };
  const auto few = way(o);
  o.preset = Preset::reference;
  o.implicit.step = 0.005;
  const auto once = way(with_preset(o));
  EXPECT_GT(few[1], 4);
  // One solve a step against explicit steps: a tenth of a cell over some ten.
  EXPECT_NEAR(once[0], few[0], 0.1);
  EXPECT_NEAR(once[1], few[1], 0.1);
}

TEST_P(ImplicitContact, slides_down_an_incline_with_friction) {
  const double angle = 30 * std::numbers::pi / 180, slope = std::tan(angle);
  Domain d = filled(ground(40, 16, 1.0, 1.0, [&](double x, double) { return 100 - slope * x; }), {4, 10, 5, 11, 0, 2});
  SolveOptions o = elastic_options(1e8, Integrator::newmark);
  o.implicit.newmark = {0.5, 1};  // backward Euler in velocity
  o.implicit.step = 0.02;
  o.base.friction_angle = 20;
  const SceneRun run(d, o, GetParam());
  const Centre start = run.now();
  int newton = 0;
  double cfl = 0;
  run_to(*run.solver, 1.5, [&](const BatchReport& batch) {
    newton += batch.stats.newton;
    cfl = batch.stats.over_cfl;
  });
  const Centre end = run.now();
  const double a = 9.81 * (std::sin(angle) - std::tan(20 * std::numbers::pi / 180) * std::cos(angle));
  // Backward Euler: s = a t (t + dt) / 2.
  const double expected = 0.5 * a * 1.5 * (1.5 + 0.02) * std::cos(angle);
  EXPECT_NEAR((end.x - start.x) / expected, 1, 0.02);
}

TEST_P(ImplicitContact, slides_through_a_hollow_as_explicit_steps_do) {
  // Where the ground bends, the reaction turns the path, and friction goes with it.
  Domain d = ground(64, 14, 1.0, 1.0, [](double x, double) { return 0.01 * (44 - x) * (44 - x); });
  fill(d, {8, 12, 5, 9, 0, 2});
  SolveOptions o = elastic_options(1e8);
  o.base.friction_angle = 15;
  const auto slide = [&](Integrator integrator, StepStats& last) {
    o.integrator = integrator;
    o.implicit.step = 0.03;
    o.implicit.newton_tolerance = 1e-5;
    const SceneRun run(d, o, GetParam());
    const auto thickness = run.solver->thickness();
    EXPECT_NEAR(std::accumulate(thickness.begin(), thickness.end(), 0.0), 32, 1e-9) << "before the first step";
    const double start = run.now().x;
    run_to(*run.solver, 4.0,
           [&](const BatchReport& batch) { last.over_cfl = std::max(last.over_cfl, batch.stats.over_cfl); });
    return run.now().x - start;
  };
  StepStats stats;
  const double expected = slide(Integrator::explicit_, stats), got = slide(Integrator::newmark, stats);
  EXPECT_GT(expected, 15);
  EXPECT_GT(stats.over_cfl, 8);
  EXPECT_NEAR(got / expected, 1, 0.008);  // with the arrival's friction counted as Newmark spreads it, 1.1 % short
}

/// A column 1.5 times as high as wide, one cell deep.
Domain heap_of_sand() { return filled(ground(26, 6, 0.1, 0.1, flat), {0.35, 0.95, 0.25, 0.35, 0, 0.9}); }

/// Sand without cohesion on a rough floor, between rollers.
SolveOptions heap_options(Integrator integrator) {
  SolveOptions o = stepping_by(integrator);
  o.material.youngs_modulus = 2e6;
  o.mapping = Mapping::cartesian;
  o.material.poisson_ratio = 0.3;
  o.material.density = 2650;
  o.material.friction_angle = 31;
  o.material.dilatancy_angle = 1;
  o.material.cone = Cone::plane_strain;
  o.base.friction_angle = 28;
  o.walls = {{Axis::x, 0.35, Side::above}, {Axis::y, 0.25, Side::above}, {Axis::y, 0.35, Side::below}};
  o.implicit.step = 0.018;
  o.implicit.newton_tolerance = 1e-4;
  o.implicit.linear_tolerance = 1e-3;
  return o;
}

TEST_P(ImplicitContact, lets_a_heap_of_sand_collapse_at_ten_times_the_cfl_step) {
  // Yielding, opening, stick and slip in one. Against explicit steps.
  const Domain d = heap_of_sand();
  const auto collapse = [&](Integrator integrator, StepStats& sums) {
    const SolveOptions o = heap_options(integrator);
    const SceneRun run(d, o, GetParam());
    run_to(*run.solver, 1.0, [&](const BatchReport& batch) {
      sums.newton += batch.stats.newton;
      sums.cuts += batch.stats.cuts;
      sums.over_cfl = std::max(sums.over_cfl, batch.stats.over_cfl);
    });
    return run.now().x - 0.35;
  };
  StepStats none;
  const double expected = collapse(Integrator::explicit_, none);
  EXPECT_GT(expected, 0.4);  // it has moved: its centre began at 0.3 m
  StepStats sums;
  const double got = collapse(Integrator::newmark, sums);
  EXPECT_NEAR(got / expected, 1, 0.05);
  EXPECT_GT(sums.over_cfl, 8);
  EXPECT_LE(sums.cuts, 5);
}

}  // namespace
}  // namespace talus::solver::testing
