// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Separation of a mass from its bed: what is thrown over a crest, what falls, and what both cost in energy.
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

  /// The elevation of the ground [m] and its slope [-].
  double elevation(double x) const { return x < edge ? 0 : -0.5 * bend * (x - edge) * (x - edge); }
  double slope(double x) const { return x < edge ? 0 : -bend * (x - edge); }
  /// The speed along x of a point that slides over the crest without friction, never leaving it [m/s].
  double pace(double x) const {
    return std::sqrt((speed * speed - 2 * pull * elevation(x)) / (1 + slope(x) * slope(x)));
  }
  /// Where such a point is after some time [m].
  double slides_to(double x, double time) const {
    constexpr int parts = 2000;
    for (int n = 0; n < parts; ++n) x += time / parts * pace(x);
    return x;
  }
};

class Separated : public InEachPlace {
 protected:
  static Domain domain(const Crest& c) {
    Domain d = ground(60, 8, 1.0, c.layer_height, [&](double x, double) { return c.elevation(x); });
    const double apart = std::min(c.thickness, c.layer_height) / 2;
    fill(d, {Crest::start, Crest::start + c.length, 2, 6, 0, c.thickness}, 2,
         static_cast<int>(std::lround(c.layer_height / apart)));
    return d;
  }
  static SolveOptions options(Separation separation, Integrator integrator = Integrator::explicit_) {
    SolveOptions o = stepping_by(integrator);
    o.base.law = FrictionLaw::none;
    o.base.separation = separation;
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
  Run run(domain(crest), options(Separation::free), GetParam(), time);
  // The middle of the slab crosses the edge at 0.3 s, its ends 0.2 s sooner and later. The ground's splines round the
  // edge off over a cell to either side.
  const double flight = time - (crest.edge - run.first.x) / Crest::speed, apart = 0.2 * 0.2 / 3;
  const double early = flight + 1 / Crest::speed;
  const double fallen = run.first.z - run.now().z, before = run.solver->energies().momentum.z;
  EXPECT_GT(fallen, 0.5 * pull * (flight * flight + apart));
  EXPECT_LT(fallen, 0.5 * pull * (early * early + apart));
  EXPECT_NEAR(run.now().x, run.first.x + Crest::speed * time, 0.05);
  run_to(*run.solver, time + 0.1);
  EXPECT_NEAR(run.solver->energies().momentum.z - before, -run.mass() * pull * 0.1, 1e-9 * run.mass()) << "all of it";
}

TEST_P(Separated, a_slab_that_may_not_leave_its_bed_slides_over_the_crest) {
  const Integrator steps = Integrator::explicit_, columns = Integrator::column_implicit;
  for (const auto& [crest, integrator] : {std::pair{Crest{0.5, 2}, steps},
                                          {Crest{0.5, 1}, steps},
                                          {Crest{0.5, 0.25}, steps},
                                          {Crest{2, 0.5}, steps},
                                          {Crest{0.5, 0.25}, columns},
                                          {Crest{2, 0.5}, columns}}) {
    const SolveOptions o = options(Separation::none, integrator);
    const Run run(domain(crest), o, GetParam(), time);
    double height = 0, ahead = 0, high = 0;
    const auto now = run.places();
    for (const auto& place : now) height += (place[2] - crest.elevation(place[0])) / static_cast<double>(now.size());
    constexpr int parts = 16;
    for (int n = 0; n < parts; ++n) {
      const double there = crest.slides_to(Crest::start + crest.length * (n + 0.5) / parts, time);
      ahead += there / parts;
      high += 0.5 * crest.thickness * Crest::speed / crest.pace(there) / parts;  // what slows along x gets thicker
    }
    const Energies e = run.solver->energies();
    const double x = run.now().x, way = ahead - run.first.x;
    const double gained = run.before.kinetic + run.before.potential - e.potential;
    EXPECT_NEAR(height, high, 0.1 * high) << crest.layer_height;
    EXPECT_NEAR(x, ahead, 0.005 * way);  // 0.1 % in 2 m, which is not thin beside the 10 m of the crest's bend
    EXPECT_NEAR(e.kinetic, gained, 0.025 * gained);  // the edge, and a step's worth of bend in every step, are lost
  }
}

TEST_P(Separated, what_is_pulled_to_the_ground_rubs_none) {
  // All of the slab is past the edge: nothing presses on the ground until it is slow, which it never is.
  Crest crest{0.5, 1};
  crest.edge = 6;
  crest.length = 4;
  SolveOptions o = options(Separation::none);
  const Run smooth(domain(crest), o, GetParam(), 0.5);
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 40;
  const Run rough(domain(crest), o, GetParam(), 0.5);
  const double rubbed = rough.solver->clock().budget.friction_loss / rough.solver->energies().kinetic;
  EXPECT_LT(std::abs(rubbed), 0.005) << "0.5 s of mu g cos v would take a third";
  EXPECT_NEAR(rough.solver->energies().kinetic, smooth.solver->energies().kinetic,
              0.005 * smooth.solver->energies().kinetic);
}

TEST_P(Separated, momentum_and_volume_are_kept_in_account_of_what_the_bed_gives) {
  for (const Separation separation : {Separation::free, Separation::none, Separation::thin}) {
    const Run run(domain({0.5, 1}), options(separation), GetParam(), time);
    const Energies e = run.solver->energies();
    const Clock clock = run.solver->clock();
    const double size = run.mass() * Crest::speed;
    EXPECT_NEAR(e.momentum.x, run.before.momentum.x + clock.budget.reaction[0], 1e-9 * size);
    EXPECT_NEAR(e.momentum.z, run.before.momentum.z + clock.budget.reaction[2] - run.mass() * pull * time, 1e-9 * size);
    EXPECT_NEAR(e.volume, run.before.volume, 1e-12 * e.volume);
  }
}

/// The largest difference in place between two runs [m].
double apart(const std::vector<std::array<double, 3>>& a, const std::vector<std::array<double, 3>>& b) {
  double most = 0;
  for (std::size_t p = 0; p < a.size(); ++p)
    for (std::size_t d = 0; d < 3; ++d) most = std::max(most, std::abs(a[p][d] - b[p][d]));
  return most;
}

TEST_P(Separated, thin_slabs_are_held_and_thick_ones_free) {
  // On the CPU to the bit; on a GPU sums are made in any order.
  const double rounding = GetParam() == On::gpu ? 1e-9 : 0;
  const auto run = [&](const Crest& c, const SolveOptions& o) { return Run(domain(c), o, GetParam(), 0.4).places(); };
  const Crest thin{0.5, 0.5}, thick{3, 1};
  EXPECT_LE(apart(run(thin, options(Separation::thin)), run(thin, options(Separation::none))), rounding);
  EXPECT_LE(apart(run(thick, options(Separation::thin)), run(thick, options(Separation::free))), rounding);
  EXPECT_GT(apart(run(thin, options(Separation::thin)), run(thin, options(Separation::free))), 0.1);
  SolveOptions deeper = options(Separation::thin);
  deeper.base.separation_depth = 4;
  EXPECT_LE(apart(run(thick, deeper), run(thick, options(Separation::none))), rounding);
}

TEST_P(Separated, a_lobe_above_a_resting_one_flies_on) {
  Domain d = filled(ground(30, 10, 1.0, 1.0, flat), {4, 24, 3, 7, 0, 0.5}, 2, 4);
  const std::size_t resting = d.points.x.size();
  fill(d, {8, 12, 3, 7, 6, 7}, 2, 4);
  for (const Separation separation : {Separation::none, Separation::thin}) {
    SolveOptions o = options(separation);
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
}

TEST_P(Separated, a_fall_is_lost_in_landing) {
  // The bed is met by functions that reach a layer and a half up: that far the weight still adds to the fall, and the
  // record leaves the weight out.
  constexpr double fall = 10;
  for (const double layer : {0.5, 1.0}) {
    Domain d = ground(24, 24, 1.0, layer, flat);
    fill(d, {8, 16, 8, 16, fall, fall + 0.5}, 2, static_cast<int>(std::lround(4 * layer)));
    SolveOptions o = options(Separation::free);
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
  SolveOptions o = options(Separation::free);
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
