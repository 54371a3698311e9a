// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact between the nodes: obstacles given as level sets.
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double g = 9.81;

/// An upright box as a level set, in a file of its own.
ObstacleOptions box_obstacle(const std::string& name, const Box& b, double voxel) {
  const auto file = std::filesystem::temp_directory_path() / ("talus_" + name + ".vdb");
  const auto distance = [b](double x, double y, double z) {
    const double dx = std::max(b.x0 - x, x - b.x1), dy = std::max(b.y0 - y, y - b.y1),
                 dz = std::max(b.bottom - z, z - b.top);
    return std::max({dx, dy, dz});
  };
  write_level_sets(file, {{name, {b.x0, b.y0, b.bottom}, {b.x1, b.y1, b.top}, distance}}, voxel);
  return {name, file, "", 0};
}

SolveOptions rigid(Integrator integrator) {
  SolveOptions o;
  o.integrator = integrator;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e8;
  o.implicit.step = 0.005;
  o.implicit.newmark = {0.5, 1};
  return o;
}

class SurfaceContactTest : public InEachPlace {};

constexpr Integrator each_of_them[] = {Integrator::explicit_, Integrator::column_implicit, Integrator::newmark};
const char* name_of(Integrator i) {
  return i == Integrator::newmark ? "newmark" : i == Integrator::column_implicit ? "column-implicit" : "explicit";
}

TEST_P(SurfaceContactTest, wall_takes_the_momentum_of_what_it_stops) {
  Domain d = ground(48, 24, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {10, 16, 8, 14, 0, 3});
  for (const Integrator integrator : each_of_them) {
    SolveOptions o = rigid(integrator);
    o.initial_velocity = {5, 0, 0};
    o.base.law = FrictionLaw::none;
    o.obstacles = {box_obstacle("wall", {24.3, 25.1, 2, 20, -2, 6}, 0.1)};
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    const double came = solver->energies().momentum.x;
    run_to(*solver, 4);
    const double left = solver->energies().momentum.x, given = solver->obstacle_impulses().at(0).x;
    double farthest = 0;
    const ParticleState s = solver->state().points;
    for (const auto& x : positions(scene, s)) farthest = std::max(farthest, x[0]);
    std::printf("  %s: came with %.6g, left with %.6g, wall was given %.6g; farthest %.2f m\n", name_of(integrator),
                came, left, given, farthest);
    EXPECT_NEAR(came - left, given, (integrator == Integrator::newmark ? scheme_of(o).tolerance : 1e-9) * came);
    EXPECT_LT(left, 0);  // elastic: it comes back
    EXPECT_LT(farthest, 24.3);
  }
}

TEST_P(SurfaceContactTest, thin_wall_carries_earth_pressure) {
  // A column between rollers and a wall a third of a cell thick, at rest: K0 rho g H^2 W / 2 with K0 = nu / (1 - nu).
  Domain d = ground(24, 16, 1.0, 1.0, [](double, double) { return 0.0; });
  d.grid.west = d.grid.south = -0.5;  // nodes at whole metres, where the rollers stand
  fill(d, {5, 11.5, 5, 11, 0, 4});
  for (const Integrator integrator : each_of_them) {
    SolveOptions o = rigid(integrator);
    o.damping = 0.3;
    o.base.law = FrictionLaw::none;
    o.walls = {{Axis::x, 5, Side::above, WallKind::roller},
               {Axis::y, 5, Side::above, WallKind::roller},
               {Axis::y, 11, Side::below, WallKind::roller}};
    o.obstacles = {box_obstacle("thin", {11.5, 11.8, 2, 14, -2, 8}, 0.1)};
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    run_to(*solver, 6);
    const Vec3<double> before = solver->obstacle_impulses().at(0);
    run_to(*solver, 8);
    const Vec3<double> after = solver->obstacle_impulses().at(0);
    const double force = (after.x - before.x) / 2, k0 = o.material.poisson_ratio / (1 - o.material.poisson_ratio);
    const double expected = 0.5 * k0 * o.material.density * g * 16 * 6;
    std::printf("  %s: force %.5g N, closed form %.5g N (%.2f %%)\n", name_of(integrator), force, expected,
                100 * (force / expected - 1));
    // The wall holds the mean about its points, a tenth of a cell before it: 1.5 % of six cells. The springs of
    // implicit steps give way besides.
    EXPECT_NEAR(force, expected, (integrator == Integrator::newmark ? 0.03 : 0.02) * expected);
  }
}

TEST_P(SurfaceContactTest, sand_stays_before_a_wall_thinner_than_a_cell) {
  Domain d = ground(48, 24, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {6, 16, 4, 20, 0, 6});
  for (const Integrator integrator : each_of_them) {
    SolveOptions o;
    o.integrator = integrator;
    o.implicit.step = 0.02;
    o.implicit.newton_tolerance = 1e-4;
    o.material.youngs_modulus = 1e6;
    o.initial_velocity = {6, 0, 0};
    o.walls = {{Axis::y, 3.5, Side::above, WallKind::roller}, {Axis::y, 19.5, Side::below, WallKind::roller}};
    o.obstacles = {box_obstacle("barrier", {22.2, 22.5, -2, 26, -2, 14}, 0.1)};
    o.obstacles[0].friction_angle = 15;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, 5);
    const ParticleState s = solver->state().points;
    const auto where = positions(scene, s);
    double beyond = 0, all = 0, farthest = 0;
    for (std::size_t p = 0; p < s.size(); ++p) {
      all += s.volume[p];
      farthest = std::max(farthest, where[p][0]);
      if (where[p][0] > 22.5) beyond += s.volume[p];
    }
    std::printf("  %s: %.2f %% beyond the wall, farthest %.2f m; wall was given %.4g N s\n", name_of(integrator),
                100 * beyond / all, farthest, solver->obstacle_impulses().at(0).x);
    EXPECT_EQ(beyond, 0);
    EXPECT_GT(farthest, 20.5);  // it got there
  }
}

TALUS_IN_EACH_PLACE(SurfaceContactTest);

}  // namespace
}  // namespace talus::solver::testing
