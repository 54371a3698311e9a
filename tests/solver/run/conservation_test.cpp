// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an explicit step must keep: mass, momentum, angular momentum, a body in free fall.
#include <cstdio>
#include <numeric>
#include <random>

#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

class Conservation : public InEachPlace {
 protected:
  /// An elastic cube in the air over flat ground, Cartesian grid.
  static Domain cube() { return filled(ground(24, 24, 1.0, 1.0, flat), {8, 14, 9, 15, 10, 16}); }
  static SolveOptions options() {
    SolveOptions o = elastic_options(1e6);
    o.mapping = Mapping::cartesian;
    o.material.density = 1000;
    o.gravity = {0, 0, 0};
    return o;
  }
};
TALUS_IN_EACH_PLACE(Conservation);

TEST_P(Conservation, falls_freely) {
  for (const auto transfer : {Transfer::apic, Transfer::flip}) {
    for (const auto shape : {ShapeKind::quadratic, ShapeKind::gimp, ShapeKind::linear}) {
      for (const auto update : {StressUpdate::last, StressUpdate::modified}) {
        SolveOptions o = options();
        o.gravity = {0, 0, -9.81};
        o.initial_velocity = {1.5, -0.5, 2};
        o.transfer = transfer;
        o.shape = shape;
        o.stress_update = update;
        const SceneRun run(cube(), o, GetParam());
        constexpr double time = 1;
        const Centre start = run.first, end = run.at(time);
        // Symplectic Euler moves with the new velocity: its fall leads the parabola by g dt t / 2, dt the mean step.
        const double lead = 0.5 * 9.81 * time * time / static_cast<double>(run.solver->clock().step);
        EXPECT_NEAR(end.x - start.x, 1.5 * time, 1e-9);
        EXPECT_NEAR(end.y - start.y, -0.5 * time, 1e-9);
        EXPECT_NEAR(end.z - start.z, 2 * time - 0.5 * 9.81 * time * time, 1.1 * lead);
        const Energies e = run.solver->energies();
        EXPECT_NEAR(e.momentum.z / (216 * 1000), 2 - 9.81 * time, 1e-9);
        EXPECT_LT(e.elastic, 1e-9);
      }
    }
  }
}

TEST_P(Conservation, keeps_momentum_and_mass_of_a_shaken_body) {
  for (const auto transfer : {Transfer::apic, Transfer::flip}) {
    SolveOptions o = options();
    o.transfer = transfer;
    Scene scene = make_scene(cube(), o);
    for (std::size_t p = 0; p < scene.points.size(); ++p) {  // a shaking that is smooth on the grid
      const double x = scene.points.cell[0][p] + scene.points.offset[0][p];
      scene.points.velocity[0][p] = 3 * std::sin(0.7 * x);
      scene.points.velocity[2][p] = 2 * std::cos(0.5 * x) + 1;
    }
    const auto solver = make_solver(scene, o, GetParam());
    const Energies start = solver->energies();
    run_to(*solver, 0.5);
    const Energies end = solver->energies();
    const double scale = 216 * 1000 * 3.0;
    expect_near(end.momentum, start.momentum, 1e-12 * scale);
    EXPECT_DOUBLE_EQ(end.volume, start.volume);
    // No more energy than at the start: the grid's functions filter, they do not feed.
    EXPECT_LT(end.kinetic + end.elastic, 1.001 * (start.kinetic + start.elastic));
    EXPECT_GT(end.elastic, 0);
  }
}

/// Angular momentum about the centre, from points and their affine velocity.
Vec3<double> angular_momentum(const Solver& solver, const Scene& scene, double density) {
  const ParticleState s = solver.state().points;
  const auto x = positions(scene, s);
  const Centre c = centre(solver, scene);
  Vec3<double> total;
  for (std::size_t p = 0; p < s.size(); ++p) {
    const double m = s.volume[p] * density;
    const Vec3<double> r{x[p][0] - c.x, x[p][1] - c.y, x[p][2] - c.z};
    const Vec3<double> v{s.velocity[0][p], s.velocity[1][p], s.velocity[2][p]};
    total += Vec3<double>{r.y * v.z - r.z * v.y, r.z * v.x - r.x * v.z, r.x * v.y - r.y * v.x} * m;
    // The affine part carries m D C per point, D = 1/4 cell squared; affine is per cell.
    const double d = 0.25 * m * scene.grid.spacing;
    total += Vec3<double>{s.affine[5][p] - s.affine[7][p], s.affine[6][p] - s.affine[2][p],
                          s.affine[1][p] - s.affine[3][p]} *
             d;
  }
  return total;
}

TEST_P(Conservation, spins_an_elastic_body_without_loss_of_angular_momentum) {
  // APIC keeps it exactly in space; symplectic Euler about the moving points costs O(dt) of the stress's moment. What
  // points keep of their own velocity (transfer_time_s) is not that of the grid where they go: a hundredth in a turn.
  for (const double transfer_time : {0.0, 0.2}) {
    SolveOptions o = options();
    o.transfer_time = transfer_time;
    Scene scene = make_scene(cube(), o);
    scene.points = with_all_lists(scene.points);
    constexpr double spin = 2;  // about z [rad/s]
    for (std::size_t p = 0; p < scene.points.size(); ++p) {
      const double x = scene.points.cell[0][p] + scene.points.offset[0][p] - 10.5;
      const double y = scene.points.cell[1][p] + scene.points.offset[1][p] - 11.5;
      scene.points.velocity[0][p] = -spin * y;
      scene.points.velocity[1][p] = spin * x;
      scene.points.affine[1][p] = spin;   // dv_y / dx
      scene.points.affine[3][p] = -spin;  // dv_x / dy
    }
    const auto solver = make_solver(scene, o, GetParam());
    const Vec3<double> start = angular_momentum(*solver, scene, 1000);
    run_to(*solver, 3);  // nearly one turn
    const Vec3<double> end = angular_momentum(*solver, scene, 1000);
    const double tolerance = transfer_time > 0 ? 0.02 : 1e-3;
    EXPECT_NEAR(end.z / start.z, 1, tolerance) << transfer_time;
    EXPECT_NEAR(end.x / start.z, 0, tolerance);
    EXPECT_NEAR(end.y / start.z, 0, tolerance);
    const Energies e = solver->energies();
    EXPECT_LT(e.elastic, 0.05 * e.kinetic);  // turning is no strain
  }
}

TEST_P(Conservation, loses_velocity_finer_than_the_grid_by_time_and_not_by_steps) {
  for (const auto transfer : {Transfer::apic, Transfer::flip}) {
    const auto left = [&](double courant, double transfer_time) {
      SolveOptions o = options();
      o.transfer = transfer;
      o.transfer_time = transfer_time;
      o.cfl = courant;
      Scene scene = make_scene(cube(), o);
      std::mt19937 engine(11);
      std::uniform_real_distribution<double> u(-1e-3, 1e-3);
      for (auto& component : scene.points.velocity)
        for (double& v : component) v = u(engine);
      const auto solver = make_solver(scene, o, GetParam());
      const double start = solver->energies().kinetic;
      run_to(*solver, 0.08);  // about five CFL steps of 1 m over 32 m/s by sqrt(3)
      return solver->energies().kinetic / start;
    };
    const double few = left(0.5, 0.18), many = left(0.05, 0.18), at_once = left(0.05, 0);
    EXPECT_NEAR(few / many, 1, 0.1);  // what the grid carries swings
    EXPECT_LT(at_once, 0.5 * many);
  }
}

/// A block in layers of half a cell whose points are off their lattice by a tenth of a cell at most.
Domain scattered_block() {
  Domain d = filled(ground(24, 24, 1.0, 0.5, flat), {8, 14, 9, 15, 4, 8}, 3, 2);
  unsigned seed = 7;
  const auto noise = [&] {
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0 - 0.5;
  };
  for (std::size_t p = 0; p < d.points.size(); ++p) {
    d.points.x[p] += 0.2 * noise();
    d.points.y[p] += 0.2 * noise();
    d.points.height[p] += 0.1 * noise();
  }
  return d;
}

/// Moves points to where the weights of hats change with the place.
void keep_off_nodes(Scene& scene) {
  const double least = scene.grid.lowest_weighed;
  for (auto& offsets : scene.points.offset)
    for (double& offset : offsets)
      if (std::abs(offset) < least) offset = std::copysign(least, offset);
}

/// A velocity linear in place, on cells of this size.
struct LinearVelocity {
  double gradient[3][3] = {{0.01, 0.02, -0.03}, {0.015, -0.02, 0.01}, {0.005, 0.03, 0.02}};  // [1/s]
  double cell[3] = {1.0, 1.0, 0.5};                                                          // [m]

  void give_to(ParticleState& points) const {
    points = with_all_lists(points);
    for (std::size_t p = 0; p < points.size(); ++p) {
      for (int a = 0; a < 3; ++a) {
        double v = 0;
        for (int b = 0; b < 3; ++b) {
          v += gradient[a][b] * (points.cell[b][p] + points.offset[b][p]) * cell[b];
          points.affine[3 * b + a][p] = gradient[a][b] * cell[b];
        }
        points.velocity[a][p] = v;
      }
    }
  }
  /// The largest error of the points' gradients, as a strain, and after the first step of their volumes.
  double worst_error(const ParticleState& s, double dt, bool first) const {
    const double trace = gradient[0][0] + gradient[1][1] + gradient[2][2];
    double worst = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      if (first) worst = std::max(worst, std::abs(s.log_volume[p] - std::log1p(trace * dt)));
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          worst = std::max(worst, std::abs(s.affine[3 * b + a][p] - gradient[a][b] * cell[b]) * dt);
    }
    return worst;
  }
};

TEST_P(Conservation, deforms_uniformly_under_a_linear_velocity) {
  // Patch test: a linear velocity field gives every point inside the body the same gradient, whatever the layout.
  const LinearVelocity linear;
  for (const auto shape : {ShapeKind::quadratic, ShapeKind::gimp, ShapeKind::linear}) {
    SolveOptions o = options();
    o.shape = shape;
    o.largest_step = 1e-3;
    o.cfl = 0.8;
    Scene scene = make_scene(scattered_block(), o);
    if (shape == ShapeKind::linear) keep_off_nodes(scene);
    linear.give_to(scene.points);
    const auto solver = make_solver(scene, o, GetParam());
    solver->set_next_event(5e-4);  // one step, from zero stress
    while (solver->advance().clock.alarms.halt != at_event) {
    }
    const auto steps = solver->clock().step;
    const double worst = linear.worst_error(solver->state().points, 5e-4 / static_cast<double>(steps), steps == 1);
    EXPECT_EQ(steps, 1);
    // Rounding: velocities of 0.5 m/s and 27 terms; second order terms of det(I + dt L) are 1e-9.
    EXPECT_LT(worst, 3e-9);
  }
}

TEST_P(Conservation, keeps_horizontal_momentum_on_smooth_ground) {
  // A thin sheet collapsing on frictionless ground, points down to the very ground.
  for (const auto transfer : {Transfer::apic, Transfer::flip}) {
    Domain d = filled(ground(30, 30, 1.0, 1.0, flat), {10, 18, 10, 18, 0, 2}, 2, 3);
    for (std::size_t p = 0; p < d.points.size(); p += 5) d.points.height[p] = 0.01;
    SolveOptions o;
    o.transfer = transfer;
    o.base.law = FrictionLaw::none;
    o.initial_velocity = {2, -1, 0};
    o.material.youngs_modulus = 1e6;
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    const Energies start = solver->energies();
    run_to(*solver, 1.0);
    const Energies end = solver->energies();
    EXPECT_NEAR(end.momentum.x / start.momentum.x, 1, 1e-12);
    EXPECT_NEAR(end.momentum.y / start.momentum.y, 1, 1e-12);
    EXPECT_LT(total(end), 1.001 * total(start));
  }
}

TEST_P(Conservation, counts_what_leaves) {
  SolveOptions o;
  o.base.law = FrictionLaw::none;
  o.initial_velocity = {8, 0, 0};
  o.material.youngs_modulus = 1e6;
  const Scene scene = make_scene(filled(ground(16, 12, 1.0, 1.0, flat), {3, 7, 4, 8, 0, 2}), o);
  const double released = std::accumulate(scene.points.volume.begin(), scene.points.volume.end(), 0.0);
  const auto solver = make_solver(scene, o, GetParam());
  double left = 0;
  run_to(*solver, 1.0, [&](const BatchReport& batch) { left += batch.outflow_volume; });
  EXPECT_GT(left, 0);
  EXPECT_GT(solver->particle_count(), 0);
  EXPECT_NEAR(left + solver->energies().volume, released, 1e-12 * released);
}

TEST_P(Conservation, maps_the_points_volume) {
  Domain d = ground(20, 20, 2.0, 1.0, [](double x, double y) { return 0.1 * x + 0.05 * y; });
  fill(d, {10, 20, 10, 20, 0, 3});
  for (const auto precision : {Precision::double_, Precision::single_}) {
    for (const auto shape : {ShapeKind::quadratic, ShapeKind::gimp, ShapeKind::linear}) {
      SolveOptions o;
      o.precision = precision;
      o.shape = shape;
      const SceneRun run(d, o, GetParam(), 0.3);
      const auto map = run.solver->thickness();
      const double on_map = 4.0 * std::accumulate(map.begin(), map.end(), 0.0);
      EXPECT_NEAR(on_map, run.solver->energies().volume, 1e-12 * on_map);
    }
  }
}

/// A slide of sand: what it had is what it has and what was lost on the way, each loss counted where it happens.
TEST_P(Conservation, closes_the_energy_budget_of_a_slide) {
  Domain d = ground(40, 16, 1.0, 0.5, [](double x, double) { return x < 20 ? 0.03 * (20 - x) * (20 - x) : 0.0; });
  fill(d, {4, 9, 5, 11, 0, 2});
  for (const auto& [integrator, damping] : {std::pair{Integrator::explicit_, 0.0},
                                            {Integrator::explicit_, 0.05},
                                            {Integrator::column_implicit, 0.0},
                                            {Integrator::column_implicit, 0.05}}) {
    SolveOptions o = stepping_by(integrator);
    o.energy_budget = true;
    o.damping = damping;
    o.material.cohesion = 1000;
    o.material.dilatancy_angle = 1;
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    const Energies start = solver->energies();
    run_to(*solver, 6.0);
    const Energies end = solver->energies();
    const Clock clock = solver->clock();
    const double gone = start.kinetic + start.potential + start.elastic - end.kinetic - end.potential - end.elastic;
    const double lost =
        clock.budget.bed_loss + clock.budget.damping_loss + clock.budget.plastic_loss + clock.budget.transfer_loss;
    EXPECT_GT(gone, 0.5 * start.potential);
    EXPECT_NEAR(lost, gone, 0.01 * gone);
    EXPECT_GT(clock.budget.bed_loss, 0.2 * gone);
    EXPECT_GT(clock.budget.plastic_loss, 0);
    EXPECT_EQ(clock.budget.damping_loss > 0, damping > 0);
    std::printf(
        "  of %.4g J: bed %.1f %%, plastic flow %.1f %%, damping %.1f %%, between points and grid %.1f %%, not "
        "accounted for %.2f %%\n",
        gone, 100 * clock.budget.bed_loss / gone, 100 * clock.budget.plastic_loss / gone,
        100 * clock.budget.damping_loss / gone, 100 * clock.budget.transfer_loss / gone, 100 * (gone - lost) / gone);
  }
}

}  // namespace
}  // namespace talus::solver::testing
