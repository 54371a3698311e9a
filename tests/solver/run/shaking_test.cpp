// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ground that shakes: a block slides on its plane as Newmark (1965) says, and a free mass takes up the integral of the
// accelerogram.
#include "solver/boundary/column_flow.hpp"
#include "solver/run/run_loop.hpp"
#include "solver/state/clock.hpp"
#include "tests/common/shaken_block.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

using test::GroundRecord;
using test::ShakenPlane;

/// The record as the solver takes it.
Shaking shaking_of(const GroundRecord& record) {
  std::vector<Vec3<double>> accelerations;
  for (std::size_t n = 0; n < record.time.size(); ++n) accelerations.push_back({record.east[n], 0, record.up[n]});
  return make_shaking(record.time, accelerations);
}

class ShakingGround : public InEachPlace {
 protected:
  /// A block 2 m square and 1 m thick: it is as good as rigid, for waves cross it in a thousandth of a second. For
  /// steps that the layers do not bound those are a quarter of a cell high.
  static Domain block_on(const ShakenPlane& plane, Integrator integrator) {
    const double slope = std::tan(ShakenPlane::radians(plane.angle));
    const double layer = integrator == Integrator::column_implicit ? 0.25 : 1;
    return filled(ground(14, 10, 1.0, layer, [&](double x, double) { return 50 - slope * x; }), {4, 6, 4, 6, 0, 1});
  }
  static SolveOptions options(Integrator integrator) {
    SolveOptions o = elastic_options(1e9, integrator);  // the closed form is that of a rigid block
    o.implicit.step = 0.01;
    o.implicit.newmark = {0.5, 1};
    o.gravity_loading_steps = 2;
    return o;
  }
  /// The way of the block's centre down the plane until `end` [m].
  double slides(const ShakenPlane& plane, const GroundRecord& record, Integrator integrator, double end) const {
    SolveOptions o = options(integrator);
    o.base.friction_angle = plane.friction;
    Scene scene = make_scene(block_on(plane, integrator), o);
    scene.points = loaded_by_gravity(scene, o, make_device(GetParam()));
    scene.shaking = shaking_of(record);
    const auto solver = make_solver(scene, o, GetParam());
    const Centre before = centre(*solver, scene);
    run_to(*solver, end);
    const Centre after = centre(*solver, scene);
    return (after.x - before.x) / std::cos(ShakenPlane::radians(plane.angle));
  }
  /// This method compares that way with that of a rigid block.
  void expect_way(const char* words, const ShakenPlane& plane, const GroundRecord& record, double end) const {
    const double expected = plane.way(record, end);
    for (const Integrator integrator : moving_integrators) {
      const double way = slides(plane, record, integrator, end);
      EXPECT_NEAR(way, expected, 0.01 * expected) << words << ", " << name_of(integrator);  // validation.md B7
    }
  }
};
TALUS_IN_EACH_PLACE(ShakingGround);

TEST_P(ShakingGround, moves_a_block_by_a_pulse_as_newmark_says) {
  const ShakenPlane plane{15, 25};
  const double strength = 0.5 * 9.81, begin = 0.1, length = 0.3;
  const GroundRecord record = test::pulse(strength, begin, begin + length);
  const double end = begin + plane.time_of_pulse(strength, length) + 0.1, way = plane.way_of_pulse(strength, length);
  EXPECT_NEAR(plane.way(record, end), way, 1e-4 * way);
  expect_way("pulse", plane, record, end);
}

TEST_P(ShakingGround, moves_a_block_by_a_train_of_waves) {
  expect_way("sines", {25, 32}, test::sine_train(4, 1.5, 3, 0.1), 2.6);
}

TEST_P(ShakingGround, moves_a_block_by_an_irregular_record) {
  expect_way("irregular", {15, 22}, test::irregular(8, 3, 0.05, 7), 3.5);
}

TEST_P(ShakingGround, moves_no_block_that_friction_holds) {
  const ShakenPlane plane{15, 25};  // yields at 0.176 g
  for (const Integrator integrator : moving_integrators)
    EXPECT_NEAR(slides(plane, test::sine_train(0.16 * 9.81, 2, 2, 0.1), integrator, 1.2), 0, 1e-4)
        << name_of(integrator);
}

/// A mass on level ground without friction: nothing but the shaking acts along the ground.
struct FreeMass {
  Scene scene;
  SolveOptions options;
  std::unique_ptr<Solver> solver;
  double mass = 0;

  FreeMass(const SolveOptions& with, const Shaking& shaking, On on) : options(with) {
    SolveOptions& o = options;
    o.base.law = FrictionLaw::none;
    o.material.model = MaterialModel::hencky;
    o.material.youngs_modulus = 1e7;
    scene = make_scene(filled(ground(20, 20, 1.0, 1.0, flat), {8, 12, 8, 12, 0, 2}), o);
    scene.shaking = shaking;
    solver = make_solver(scene, o, on);
    for (const double volume : scene.points.volume) mass += volume * o.material.density;
  }
};

/// Uneven samples with a pulse that is shorter than any step.
Shaking uneven_shaking() {
  return make_shaking({0.013, 0.0214, 0.0215, 0.0216, 0.1, 0.17, 0.31},
                      {{1, 2, 0}, {0.5, -1, 0}, {400, -300, 0}, {0.5, -1, 0}, {-3, 1, 0}, {2, -2, 0}, {0, 1, 0}});
}

TEST_P(ShakingGround, gives_a_free_mass_the_integral_of_the_record) {
  const Shaking shaking = uneven_shaking();
  for (const Integrator integrator : moving_integrators) {
    for (const bool trapezoid : {false, true}) {
      SolveOptions o = stepping_by(integrator);
      o.implicit.newton_tolerance = 1e-12;
      o.implicit.step = 0.017;
      if (!trapezoid) o.implicit.newmark = {0.5, 1};
      const FreeMass body(o, shaking, GetParam());
      for (const double time : {0.0215, 0.05, 0.2, 0.4}) {
        run_to(*body.solver, time);
        const Vec3<double> momentum = body.solver->energies().momentum, velocity = shaking.view().velocity_at(time);
        const double rounding =
            (integrator == Integrator::newmark ? 1e-8 : 1e-12) * body.mass * shaking.peak_velocity();
        EXPECT_NEAR(momentum.x, -body.mass * velocity.x, rounding) << name_of(integrator) << " at " << time;
        EXPECT_NEAR(momentum.y, -body.mass * velocity.y, rounding) << name_of(integrator) << " at " << time;
      }
    }
  }
}

TEST_P(ShakingGround, is_met_by_implicit_steps_at_every_sample) {
  const Shaking shaking = uneven_shaking();
  SolveOptions o = stepping_by(Integrator::newmark);
  o.implicit.step = 0.005;
  const FreeMass body(o, shaking, GetParam());
  body.solver->set_next_event(0.4);
  for (const ShakingSample& sample : shaking.samples) {
    double time = 0;
    while (time < sample.time * (1 - 1e-9)) time = body.solver->advance().clock.time;
    EXPECT_NEAR(time, sample.time, 1e-12);
  }
}

TEST_P(ShakingGround, does_the_work_that_the_energy_budget_says) {
  for (const Integrator integrator : flow_integrators) {
    SolveOptions o = options(integrator);
    o.energy_budget = true;
    const ShakenPlane plane{15, 25};
    o.base.friction_angle = plane.friction;
    Scene scene = make_scene(block_on(plane, integrator), o);
    scene.points = loaded_by_gravity(scene, o, make_device(GetParam()));
    scene.shaking = shaking_of(test::irregular(5, 1.5, 0.05, 7));
    const auto solver = make_solver(scene, o, GetParam());
    const double before = total(solver->energies());
    run_to(*solver, 1);
    const Clock clock = solver->clock();
    const double lost =
        clock.budget.bed_loss + clock.budget.damping_loss + clock.budget.plastic_loss + clock.budget.transfer_loss;
    const double work = clock.budget.shaking_work, found = total(solver->energies()) - before + lost;
    EXPECT_GT(std::abs(work), 0.2 * lost) << name_of(integrator);  // what is left out shows
    EXPECT_NEAR(found, work, 0.01 * lost);                         // right to the order of the step
  }
}

TEST_P(ShakingGround, goes_on_after_a_restart_as_if_there_had_been_none) {
  const Shaking shaking = uneven_shaking();
  for (const Integrator integrator : moving_integrators) {
    SolveOptions o = stepping_by(integrator);
    o.implicit.newton_tolerance = 1e-12;
    const FreeMass body(o, shaking, GetParam());
    run_to(*body.solver, 0.12);
    const auto again = resume_solver(body.scene, body.options, GetParam(), body.solver->state());
    run_to(*body.solver, 0.3);
    run_to(*again, 0.3);
    const double rounding = 1e-9 * body.mass * shaking.peak_velocity();  // points have been sorted anew
    EXPECT_NEAR(again->energies().momentum.x, body.solver->energies().momentum.x, rounding) << name_of(integrator);
    EXPECT_EQ(again->clock().shaking.velocity[0], body.solver->clock().shaking.velocity[0]);
  }
}

TEST(Shaking, is_part_of_what_presses_columns_on_their_bed) {
  Clock clock;
  clock.time = 1;
  clock.step_size = 0.5;
  const ColumnStep step{&clock, 0, {{0, 0, -9.81}, 2}};
  EXPECT_DOUBLE_EQ(step.press(Vec3<double>{0, 0, 1}), 0.5 * 9.81) << "half of the ramp";
  clock.shake({0, 0, 1.5});
  EXPECT_DOUBLE_EQ(step.press(Vec3<double>{0, 0, 1}), 0.5 * 9.81 + 3);
  EXPECT_DOUBLE_EQ(step.press(Vec3<double>{0.6, 0, 0.8}), 0.8 * (0.5 * 9.81 + 3));
  clock.shake({0, 0, -2});
  EXPECT_EQ(step.press(Vec3<double>{0, 0, 1}), 0) << "the ground falls away faster than the mass";
}

}  // namespace
}  // namespace talus::solver::testing
