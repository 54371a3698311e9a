// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes that are hard on purpose (docs/explanation/validation.md, C): each ends with the invariant it names.
#include <random>

#include "solver/run/run_loop.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct Way {
  const char* name;
  Integrator integrator;
  ShapeKind shape;
};
constexpr Way ways[] = {{"explicit, quadratic", Integrator::explicit_, ShapeKind::quadratic},
                        {"explicit, gimp", Integrator::explicit_, ShapeKind::gimp},
                        {"column-implicit, quadratic", Integrator::column_implicit, ShapeKind::quadratic},
                        {"newmark, quadratic", Integrator::newmark, ShapeKind::quadratic}};

SolveOptions options_for(const Way& way) {
  SolveOptions o = stepping_by(way.integrator);
  o.shape = way.shape;
  o.implicit.newton_tolerance = 1e-4;
  return o;
}

class HardCases : public InEachPlace {
 protected:
  /// How far the centre of a scene goes between two times [m].
  static double creep(const Scene& scene, const SolveOptions& o, double from, double to) {
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, from);
    const Centre start = centre(*solver, scene);
    run_to(*solver, to);
    const Centre end = centre(*solver, scene);
    return std::hypot(end.x - start.x, end.y - start.y, end.z - start.z);
  }

  /// Runs to `end` and gives `look` the energies every `interval`.
  template <class Look>
  static std::unique_ptr<Solver> watch(const Scene& scene, const SolveOptions& o, double end, double interval,
                                       Look&& look) {
    auto solver = make_solver(scene, o, GetParam());
    const long looks = std::lround(end / interval);
    double next = 0;
    for (long n = 0; n < looks; ++n) {
      next += interval;
      run_to(*solver, next);
      look(*solver);
    }
    return solver;
  }
};
TALUS_IN_EACH_PLACE(HardCases);

/// Points that carry a billionth of the others' mass, in a body and alone.
Domain with_slivers(double height) {
  Domain d = filled(ground(24, 24, 1.0, 1.0, flat), {8, 12, 8, 12, height, height + 4});
  for (std::size_t p = 0; p < d.points.size(); p += 3) d.points.volume[p] *= 1e-9;
  fill(d, {15, 15.5, 15, 15.5, height, height + 0.5});  // one alone in its cells
  return d;
}

TEST_P(HardCases, slivers_fly_with_the_body) {  // C4
  const Domain d = with_slivers(6);
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    SolveOptions o = options_for(way);
    o.gravity = {0, 0, 0};
    o.initial_velocity = {3, -2, 1};
    o.implicit.step = 0.02;
    const SceneRun run(d, o, GetParam(), 0.5);
    const ParticleState s = run.solver->state().points;
    double worst = 0;
    for (std::size_t p = 0; p < s.size(); ++p)
      for (std::size_t a = 0; a < 3; ++a) worst = std::max(worst, std::abs(s.velocity[a][p] - o.initial_velocity[a]));
    // Rounding of the velocity's differences times stiffness over mass, as far as the step allows.
    EXPECT_LT(worst, 1e-9);
  }
}

TEST_P(HardCases, energy_never_grows_where_slivers_fall_with_sand) {  // C4, C6
  const Domain d = with_slivers(1);
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    SolveOptions o = options_for(way);
    o.material.youngs_modulus = 1e6;
    o.implicit.step = 0.01;
    const Scene scene = make_scene(d, o);
    double last = total(make_solver(scene, o, GetParam())->energies());
    const double first = last;
    watch(scene, o, 2, 0.1, [&](Solver& solver) {
      const double now = total(solver.energies());
      EXPECT_LT(now, last + 2e-3 * first) << "at " << solver.clock().time << " s";
      EXPECT_TRUE(std::isfinite(now));
      last = now;
    });
  }
}

TEST_P(HardCases, impact_at_fifty_metres_a_second_stays_above_the_rock) {  // C5
  Domain d = filled(ground(48, 48, 1.0, 1.0, flat), {22, 26, 22, 26, 1, 5});
  for (const Way& way : ways) {
    SCOPED_TRACE(way.name);
    SolveOptions o = options_for(way);
    o.initial_velocity = {2, 0, -50};
    o.base.law = FrictionLaw::none;
    o.implicit.step = 0.004;
    const Scene scene = make_scene(d, o);
    const Energies before = make_solver(scene, o, GetParam())->energies();
    const auto solver = watch(scene, o, 0.2, 0.05, [&](Solver& s) {
      const Energies e = s.energies();
      EXPECT_LT(total(e), total(before) * (1 + 1e-3));
      EXPECT_NEAR(e.volume, before.volume, 1e-12 * before.volume);
      // The smooth rock gives no impulse along x or y.
      EXPECT_NEAR(e.momentum.x, before.momentum.x, 1e-6 * std::abs(before.momentum.z));
      EXPECT_NEAR(e.momentum.y, 0, 1e-6 * std::abs(before.momentum.z));
    });
    const ParticleState s = solver->state().points;
    for (std::size_t p = 0; p < s.size(); ++p) ASSERT_GE(s.cell[2][p] + s.offset[2][p], -0.1);
    EXPECT_LT(std::abs(solver->energies().momentum.z), 0.5 * std::abs(before.momentum.z)) << "it was stopped";
  }
}

/// What weight, rock and wall gave is what the mass has: 1e-6 of what it came with (validation.md C5).
TEST_P(HardCases, impact_on_rock_and_wall_balances_momentum) {
  Domain d = filled(ground(48, 120, 1.0, 1.0, [](double x, double) { return 0.1 * x; }), {22, 26, 58, 62, 1, 5});
  for (const auto& [integrator, law] : {std::pair{Integrator::explicit_, FrictionLaw::coulomb},
                                        {Integrator::explicit_, FrictionLaw::stick},
                                        {Integrator::column_implicit, FrictionLaw::coulomb}}) {
    SolveOptions o = stepping_by(integrator);
    o.energy_budget = true;
    o.initial_velocity = {50, 5, -20};
    o.base.law = law;
    o.base.friction_angle = 20;
    o.walls.push_back({Axis::x, 34.5, Side::below, WallKind::frictional, 15});
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    const Energies start = solver->energies();
    const double came = std::abs(start.momentum.x), mass = start.volume * o.material.density;
    double stopped = 0, time = 0;
    for (int n = 0; n < 7; ++n) {
      time += 0.1;
      run_to(*solver, time);
      const Energies now = solver->energies();
      const Clock clock = solver->clock();
      ASSERT_NEAR(now.volume, start.volume, 1e-9) << "something left";
      EXPECT_NEAR(now.momentum.x, start.momentum.x + clock.budget.reaction[0], 1e-6 * came) << time;
      EXPECT_NEAR(now.momentum.y, start.momentum.y + clock.budget.reaction[1], 1e-6 * came) << time;
      EXPECT_NEAR(now.momentum.z, start.momentum.z + clock.budget.reaction[2] - mass * 9.81 * clock.time, 1e-6 * came)
          << time;
      stopped = -clock.budget.reaction[0] / came;
    }
    EXPECT_GT(stopped, 0.8) << "the wall was not met";
  }
}

TEST_P(HardCases, cliffs_spikes_and_pits_hold_nothing_inside_the_ground) {  // C7
  // A cliff of 80 degrees, one-cell spikes and pits at its foot.
  Domain d = ground(60, 16, 2.0, 1.0, [](double x, double y) {
    const double cliff = std::clamp((40 - x) * 5.67, 0.0, 45.0),
                 bump = x > 44 ? 3 * std::sin(1.7 * x) * std::sin(2.3 * y) : 0.0;
    return cliff + bump;
  });
  fill(d, {24, 32, 12, 16, 0, 4});
  for (const auto mapping : {Mapping::terrain_following, Mapping::cartesian}) {
    for (const Way& way : ways) {
      SCOPED_TRACE(std::string(way.name) + (mapping == Mapping::cartesian ? ", cartesian" : ""));
      SolveOptions o = options_for(way);
      o.mapping = mapping;
      o.initial_velocity = {8, 0, 0};
      o.implicit.step = 0.02;
      const Scene scene = make_scene(d, o);
      const double released = make_solver(scene, o, GetParam())->energies().volume;
      auto solver = make_solver(scene, o, GetParam());
      double left = 0;
      run_to(*solver, 4, [&](const BatchReport& batch) { left += batch.outflow_volume; });
      EXPECT_NEAR(solver->energies().volume + left, released, 1e-12 * released);
      const ParticleState s = solver->state().points;
      const auto places = positions(scene, s);
      for (std::size_t p = 0; p < s.size(); ++p) {
        const double ground_here =
            solver->ground().datum +
            terrain_at(scene.grid, solver->ground(), s.cell[0][p] + s.offset[0][p], s.cell[1][p] + s.offset[1][p]);
        ASSERT_TRUE(std::isfinite(places[p][2]));
        if (mapping == Mapping::cartesian) continue;  // its ground is stairs between nodes
        ASSERT_GE(places[p][2], ground_here - 0.1);
      }
    }
  }
}

TEST_P(HardCases, a_deposit_stays_where_it_came_to_rest) {  // C8
  Domain d = filled(ground(30, 30, 2.0, 2.0, flat), {24, 36, 24, 36, 0, 10});
  for (const Integrator integrator : flow_integrators) {
    SolveOptions o = stepping_by(integrator);
    o.material.youngs_modulus =
        2e6;  // the weight of 10 m strains it by a tenth: the softest that is still at rest as a solid is
    const SceneRun run(d, o, GetParam());
    const Centre settled = run.at(60);
    const double volume = run.solver->energies().volume;
    const Centre later = run.at(660);
    const double creep = std::hypot(later.x - settled.x, later.y - settled.y, later.z - settled.z);
    EXPECT_LT(creep, 0.01 * 2);
    EXPECT_EQ(run.solver->energies().volume, volume);
  }
}

Domain ground_of_20_degrees(double layer) {
  return ground(40, 16, 1.0, layer, [](double x, double) { return -std::tan(20 * M_PI / 180) * x; });
}

SolveOptions slab_on_a_bed_of_25_degrees() {
  SolveOptions o = stepping_by(Integrator::newmark);
  o.material.youngs_modulus = 1e8;
  o.base.friction_angle = 25;
  o.material.cohesion = 5e4;  // its upright faces stand
  o.implicit.newton_tolerance = 1e-6;
  return o;
}

TEST_P(HardCases, a_slab_below_its_friction_angle_rests_in_long_steps_too) {
  // On 20 degrees with a bed of 25; from zero and from geostatic stress, in steps of 10 CFL, and of 200, where Newton
  // first finds its way on smoothed friction and may not stay there. 1e-4 of its length in 60 s, a sixth in 10 s.
  constexpr double length = 12;
  Domain d = ground_of_20_degrees(1);
  fill(d, {10, 10 + length, 5, 8, 0, 2});
  for (const auto& [geostatic, cfl] : {std::pair{false, 10.0}, {true, 10.0}, {true, 200.0}}) {
    SolveOptions o = slab_on_a_bed_of_25_degrees();
    o.material.tension_cutoff = 1e4;
    const double wave = make_material<double>(o.material).wave_speed;
    o.implicit.step = cfl / (wave * std::sqrt(3.0));
    o.gravity_ramp = geostatic ? 0 : 1;  // from zero stress the weight comes within a second, not as a blow
    Scene scene = make_scene(d, o);
    if (geostatic) {
      // Normal stress of the weight above; confined sideways, shear by the slope.
      const auto m = make_material<double>(o.material);
      for (std::size_t p = 0; p < scene.points.size(); ++p) {
        const double above = 2 - (scene.points.cell[2][p] + scene.points.offset[2][p]);
        const double weight = o.material.density * 9.81 * above;
        scene.points.log_volume[p] = -weight / (m.bulk_modulus + 4 * m.shear_modulus / 3);
        scene.points.elastic[2][p] = 2.0 / 3 * scene.points.log_volume[p];
        scene.points.elastic[0][p] = scene.points.elastic[1][p] = -0.5 * scene.points.elastic[2][p];
      }
    }
    EXPECT_LT(creep(scene, o, 5, 65), 1e-4 * length) << cfl;
  }
}

TEST_P(HardCases, a_slab_that_has_settled_does_not_creep) {
  // On 20 degrees with a bed of 25, a minute after it was let go with its weight in place: less than a nanometre a
  // second in 600 s, in steps of 1,250 CFL.
  SolveOptions o = slab_on_a_bed_of_25_degrees();
  o.implicit.step = 2;
  o.gravity_loading_steps = 4;
  Scene scene = make_scene(filled(ground_of_20_degrees(0.5), {10, 18, 5, 9, 0, 2}), o);
  scene.points = loaded_by_gravity(scene, o, make_device(GetParam()));
  EXPECT_LT(creep(scene, o, 60, 660) / 600, 1e-9);
}

TEST_P(HardCases, far_coordinates_and_other_sizes_change_nothing) {  // C10
  Integrator integrator = Integrator::explicit_;
  const auto slide = [&](double west, double south, double scale) {
    Domain d = ground(40, 20, scale, 0.5 * scale, [&](double x, double) { return scale * 20 - 0.5 * (x - west); },
                      {west, south});
    fill(d, {6 * scale, 12 * scale, 6 * scale, 12 * scale, 0, 2 * scale});
    for (std::size_t p = 0; p < d.points.size(); ++p) {
      d.points.x[p] += west;
      d.points.y[p] += south;
    }
    SolveOptions o = stepping_by(integrator);
    o.material.youngs_modulus = 1e6 * scale;  // the same in the scale of its own weight, and of time
    o.largest_step = 1e3;
    const SceneRun run(d, o, GetParam(), 2 * std::sqrt(scale));
    std::vector<double> map = run.solver->thickness();
    for (double& t : map) t /= scale;
    return map;
  };
  const auto compare = [](const std::vector<double>& here, const std::vector<double>& there) {
    double worst = 0, most = 0;
    for (std::size_t n = 0; n < here.size(); ++n) {
      worst = std::max(worst, std::abs(here[n] - there[n]));
      most = std::max(most, here[n]);
    }
    return worst / most;
  };
  for (const Integrator each : flow_integrators) {
    integrator = each;
    const auto here = slide(0, 0, 1);
    EXPECT_LT(compare(here, slide(512000, 5000000, 1)), 1e-6) << "northing of 5,000,000 m";
    EXPECT_LT(compare(here, slide(0, 0, 0.0625)), 1e-6) << "cells of 6 cm";
    EXPECT_LT(compare(here, slide(0, 0, 64)), 1e-6) << "cells of 64 m";
  }
}

TEST_P(HardCases, single_precision_ends_within_the_discretisation_error) {  // C11
  Domain d = ground(60, 20, 2.0, 1.0, [](double x, double) { return x < 70 ? 0.4 * (70 - x) * (70 - x) / 70 : 0.0; });
  fill(d, {10, 26, 12, 28, 0, 4});
  const auto deposit = [&](Integrator integrator, Precision precision, double courant) {
    SolveOptions o = stepping_by(integrator);
    o.precision = precision;
    o.cfl = courant;
    const SceneRun run(d, o, GetParam(), 15);
    return run.solver->thickness();
  };
  for (const Integrator integrator : flow_integrators) {
    const auto whole = deposit(integrator, Precision::double_, 0.5);
    const double single = share_elsewhere(deposit(integrator, Precision::single_, 0.5), whole),
                 step = share_elsewhere(deposit(integrator, Precision::double_, 0.25), whole);
    EXPECT_LT(single, step);
    EXPECT_LT(single, 0.01);
  }
}

}  // namespace
}  // namespace talus::solver::testing
