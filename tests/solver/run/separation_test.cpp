// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Separation of a mass from its bed: what is thrown over a crest, what hops too low for that, what falls, and what it
// costs in energy.
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double pull = 9.81;

/// Level ground that bends down into a parabola, over which a slab is thrown. g / v^2 = 0.0245 1/m is what its weight
/// can follow at 20 m/s; the crest has 0.1 1/m.
struct Crest {
  double thickness;     ///< of the slab along the vertical [m]
  double layer_height;  ///< [m]
  double edge = 16;     ///< where the ground begins to bend; the slab begins at 6 m [m]
  double length = 8;    ///< of the slab [m]
  static constexpr double bend = 0.1, speed = 20, start = 6;

  /// The elevation of the ground [m].
  double elevation(double x) const { return x < edge ? 0 : -0.5 * bend * (x - edge) * (x - edge); }
};

class Separated : public InEachPlace {
 protected:
  static Domain domain(const Crest& c) {
    return domain(c, [&](double x, double) { return c.elevation(x); });
  }
  static Domain domain(const Crest& c, const std::function<double(double, double)>& elevation) {
    Domain d = ground(60, 8, 1.0, c.layer_height, elevation);
    const double apart = std::min(c.thickness, c.layer_height) / 2;
    fill(d, {Crest::start, Crest::start + c.length, 2, 6, 0, c.thickness}, 2,
         static_cast<int>(std::lround(c.layer_height / apart)));
    return d;
  }
  static SolveOptions options(Integrator integrator = Integrator::explicit_) {
    SolveOptions o = stepping_by(integrator);
    o.base.law = FrictionLaw::none;
    o.initial_velocity = {Crest::speed, 0, 0};
    o.energy_budget = true;
    o.walls = {{Axis::y, 2, Side::above}, {Axis::y, 6, Side::below}};
    return o;
  }
  /// A run after some time.
  struct Run : SceneRun {
    Energies before;
    Run(const Domain& d, const SolveOptions& o, On on, double time) : SceneRun(d, o, on), before(solver->energies()) {
      run_to(*solver, time);
    }
    std::vector<std::array<double, 3>> places() const { return positions(scene, solver->state().points); }
    double mass() const { return 2000 * before.volume; }
  };
  static constexpr double time = 0.8;  ///< in which the middle of the slab comes 10 m past the edge [s]
};
TALUS_IN_EACH_PLACE(Separated);

TEST_P(Separated, a_slab_flies_off_a_crest_that_bends_faster_than_it_falls) {
  const Crest crest{0.5, 1};
  for (const double cfl : {0.5, 0.05}) {
    SolveOptions o = options();
    o.cfl = cfl;
    Run run(domain(crest), o, GetParam(), time);
    // The middle of the slab crosses the edge at 0.3 s, its ends 0.2 s sooner and later. The ground's splines round the
    // edge off over a cell to either side.
    const double flight = time - (crest.edge - run.first.x) / Crest::speed, apart = 0.2 * 0.2 / 3;
    const double early = flight + 1 / Crest::speed;
    const double fallen = run.first.z - run.now().z, before = run.solver->energies().momentum.z;
    EXPECT_GT(fallen, 0.5 * pull * (flight * flight + apart)) << cfl;
    EXPECT_LT(fallen, 0.5 * pull * (early * early + apart)) << cfl;
    EXPECT_NEAR(run.now().x, run.first.x + Crest::speed * time, 0.05);
    run_to(*run.solver, time + 0.1);
    EXPECT_NEAR(run.solver->energies().momentum.z - before, -run.mass() * pull * 0.1, 1e-9 * run.mass()) << "all of it";
  }
}

/// Waves of 0.3 m from crest to hollow, 8 m long. A body of 20 m/s that leaves them flies up to half a metre above the
/// hollows: their crests have v^2 over their radius of 37 m/s2.
double waves(double x, double) { return 0.15 * std::cos(std::numbers::pi / 4 * x); }

TEST_P(Separated, a_slab_keeps_to_ground_from_which_it_would_hop_by_less_than_half_its_depth) {
  for (const Integrator integrator : {Integrator::explicit_, Integrator::column_implicit}) {
    const SolveOptions o = options(integrator);
    const auto above = [](const Run& run, const auto& ground) {  // mean height above the ground
      double height = 0;
      const auto now = run.places();
      for (const auto& place : now) height += (place[2] - ground(place[0], 0)) / static_cast<double>(now.size());
      return height;
    };
    const Run thick(domain({2, 1}, waves), o, GetParam(), time), even(domain({2, 1}, flat), o, GetParam(), time),
        thin(domain({0.5, 0.25}, waves), o, GetParam(), time);
    EXPECT_LT(above(thick, waves), above(even, flat) + 0.02) << static_cast<int>(integrator);
    EXPECT_GT(above(thin, waves), 0.35) << "0.25 on the ground";
    EXPECT_GT(thick.solver->clock().budget.holding_loss, 0);
    EXPECT_NEAR(thick.solver->energies().kinetic, thick.before.kinetic, 0.05 * thick.before.kinetic);
  }
}

TEST_P(Separated, what_holds_it_rubs_none) {
  // On the waves a slab of 2 m presses with its weight on average: the hold's pull adds nothing to the friction.
  SolveOptions o = options();
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 20;
  const auto rubbed = [&](const Domain& d) { return Run(d, o, GetParam(), time).solver->clock().budget.friction_loss; };
  const double on_waves = rubbed(domain({2, 1}, waves)), even = rubbed(domain({2, 1}, flat));
  EXPECT_NEAR(on_waves / even, 1, 0.5);
}

TEST_P(Separated, momentum_and_volume_are_kept_in_account_of_what_the_bed_gives) {
  for (const auto& [thickness, elevation] : {std::pair{0.5, false}, {2.0, true}}) {
    const Crest crest{thickness, 1};
    const Run run(elevation ? domain(crest, waves) : domain(crest), options(), GetParam(), time);
    const Energies e = run.solver->energies();
    const Clock clock = run.solver->clock();
    const double size = run.mass() * Crest::speed;
    EXPECT_NEAR(e.momentum.x, run.before.momentum.x + clock.budget.reaction[0], 1e-9 * size);
    EXPECT_NEAR(e.momentum.z, run.before.momentum.z + clock.budget.reaction[2] - run.mass() * pull * time, 1e-9 * size);
    EXPECT_NEAR(e.volume, run.before.volume, 1e-12 * e.volume);
  }
}

TEST_P(Separated, a_lobe_above_a_resting_one_flies_on) {
  Domain d = filled(ground(30, 10, 1.0, 1.0, flat), {4, 24, 3, 7, 0, 0.5}, 2, 4);
  const std::size_t resting = d.points.x.size();
  fill(d, {8, 12, 3, 7, 6, 7}, 2, 4);
  SolveOptions o = options();
  o.base.law = FrictionLaw::voellmy;
  o.base.turbulence = 100;
  o.initial_velocity = {5, 0, 0};
  const Run run(d, o, GetParam(), 0.5);
  const ParticleState s = run.solver->state().points;
  double slowest = 1e9;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const auto id = static_cast<std::size_t>(s.id[p]);
    if (id < resting) {
      slowest = std::min(slowest, s.velocity[0][p]);
    } else {
      EXPECT_NEAR(s.velocity[0][p], 5, 1e-9);
      EXPECT_NEAR(s.velocity[2][p], -pull * 0.5, 1e-9);
    }
  }
  EXPECT_LT(slowest, 4) << "what lies on the bed is dragged";
}

TEST_P(Separated, a_fall_is_lost_in_landing) {
  // The bed is met by functions that reach a layer and a half up: that far the weight still adds to the fall, and the
  // record leaves the weight out.
  constexpr double fall = 10;
  for (const double layer : {0.5, 1.0}) {
    Domain d = ground(24, 24, 1.0, layer, flat);
    fill(d, {8, 16, 8, 16, fall, fall + 0.5}, 2, static_cast<int>(std::lround(4 * layer)));
    SolveOptions o = options();
    o.base.law = FrictionLaw::coulomb;
    o.initial_velocity = {0, 0, 0};
    o.walls = {};
    const Run run(d, o, GetParam(), 4);
    const Energies e = run.solver->energies();
    const double due = run.mass() * pull * (fall - 1.5 * layer), landing = run.solver->clock().budget.landing_loss;
    EXPECT_NEAR(landing, due, 0.1 * due) << layer;
    EXPECT_LT(e.kinetic, 0.01 * due);
  }
}

TEST_P(Separated, a_slide_on_even_ground_lands_on_nothing) {
  Domain d = filled(ground(60, 8, 1.0, 0.5, [](double x, double) { return 40 - 0.5 * x; }), {6, 14, 2, 6, 0, 1});
  SolveOptions o = options();
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 20;
  o.initial_velocity = {8, 0, -4};
  const Run run(d, o, GetParam(), 2);
  const Clock clock = run.solver->clock();
  EXPECT_LT(std::abs(clock.budget.landing_loss), 0.03 * clock.budget.friction_loss);
  EXPECT_EQ(clock.budget.holding_loss, 0);
  EXPECT_NEAR(clock.budget.drag_loss, 0, 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
