// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From the options of a recipe to settings: units, laws, steps.
#include <cmath>
#include <numbers>

#include "common/stage/stage.hpp"
#include "solver/boundary/contact_points.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/options/implicit.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/material.hpp"
#include "solver/options/scheme.hpp"
#include "solver/scene/settings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

const GridShape grid = [] {
  GridShape shape;
  shape.spacing = 4;
  shape.layer_height = 2;
  return shape;
}();

double coefficient(double degrees) { return std::tan(degrees * (std::numbers::pi / 180)); }

TEST(Settings, angles_become_coefficients_and_words_become_laws) {
  SolveOptions o;
  o.base.friction_angle = 17;
  o.walls.push_back({.axis = Axis::y,
                     .position = 5,
                     .material_is = Side::below,
                     .kind = WallKind::frictional,
                     .friction_angle = 12,
                     .speed = 0.5,
                     .to = 2});
  o.obstacles.push_back({.name = "wall", .level_set = "a.vdb", .grid = "b", .friction_angle = 23});
  const SolverSettings s = make_settings(o, grid);
  const BaseFriction<double>& bed = s.common.bed;
  EXPECT_EQ(bed.coefficient(bed.uniform, {.speed = 0, .normal_stress = 0, .duration = 0}), coefficient(17));
  const PlaneWall& wall = s.common.walls.at(0);
  EXPECT_EQ(wall.axis, 1);
  EXPECT_EQ(wall.side, -1);
  EXPECT_EQ(wall.position, 5);
  EXPECT_EQ(wall.friction, coefficient(12));
  EXPECT_EQ(wall.speed, 0.5);
  EXPECT_EQ(wall.to, 2);
  const std::vector<Obstacle> obstacles = make_obstacles(o.obstacles);
  EXPECT_EQ(obstacles.at(0).name, "wall");
  EXPECT_EQ(obstacles.at(0).level_set, "a.vdb");
  EXPECT_EQ(obstacles.at(0).grid, "b");
  EXPECT_EQ(obstacles.at(0).friction, coefficient(23));
}

TEST(Settings, steps_transfer_and_gravity_are_those_of_the_recipe) {
  SolveOptions o;
  o.cfl = 0.3;
  o.largest_step = 0.2;
  o.transfer = Transfer::flip;
  o.stress_update = StressUpdate::modified;
  o.transfer_time = 7;
  o.gravity = {1, 2, -9};
  o.gravity_ramp = 3;
  o.initial_velocity = {3, 4, 12};
  const IntegratorSettings s = make_settings(o, grid).common;
  EXPECT_EQ(s.cfl, 0.3);
  EXPECT_EQ(s.largest_step, 0.2);
  EXPECT_EQ(s.initial_speed(), 13);
  EXPECT_EQ(s.fastest_wave, fastest_wave(o));
  EXPECT_FALSE(s.affine());
  EXPECT_TRUE(s.remaps_velocity());
  EXPECT_EQ(s.decay_time, 7);
  EXPECT_EQ(s.gravity_vector().y, 2);
  EXPECT_EQ(s.gravity_ramp, 3);
}

TEST(Settings, velocity_finer_than_the_grid_decays_as_fast_as_layers_fall) {
  SolveOptions o;
  const auto time = [&] { return make_settings(o, grid).common.decay_time; };
  const double of_layer = std::sqrt(grid.layer_height / 9.81);
  EXPECT_NEAR(time(), 0.3 * of_layer, 1e-12);
  o.material.youngs_modulus *= 100;
  o.cfl = 0.1;
  o.integrator = Integrator::column_implicit;
  EXPECT_NEAR(time(), 0.3 * of_layer, 1e-12) << "whatever the stiffness and the steps";
  o.gravity = {0, 0, 0};
  EXPECT_NEAR(time(), 10 * grid.layer_height / fastest_wave(o), 1e-12) << "waves where nothing falls";
  o.transfer_time = 0;
  EXPECT_EQ(time(), 0);
}

TEST(Settings, scheme_materials_and_loads_need_fields_of_the_particles) {
  SolveOptions o;
  const ParticleNeeds plain = make_settings(o, grid).common.needs;
  EXPECT_TRUE(plain.affine_transfer);
  EXPECT_FALSE(plain.plastic_volume || plain.boxes || plain.loads || plain.several_materials || plain.softening);
  o.shape = ShapeKind::gimp;
  o.loads.emplace_back();
  o.parts.emplace_back().material.softening_slip = 1;
  o.material.dilatancy_angle = 5;
  const ParticleNeeds all = make_settings(o, grid).common.needs;
  EXPECT_TRUE(all.plastic_volume && all.boxes && all.loads && all.several_materials && all.softening);
}

TEST(Settings, points_keep_plastic_volume_where_the_chosen_law_dilates) {
  const auto keeps = [](const SolveOptions& o) { return make_settings(o, grid).common.needs.plastic_volume; };
  SolveOptions o;
  o.material.volume_fraction = 0.62;
  EXPECT_FALSE(keeps(o)) << "it is a key of another law";
  o.material.model = MaterialModel::mu_of_i;
  EXPECT_TRUE(keeps(o));
  o.material.volume_fraction = 0;
  o.material.dilatancy_angle = 5;
  EXPECT_FALSE(keeps(o));
  o.parts.emplace_back().material.model = MaterialModel::mu_of_i;
  o.parts[0].material.volume_fraction = 0.58;
  EXPECT_TRUE(keeps(o)) << "a part of the mass does";
}

TEST(Settings, the_precisions_of_a_material_are_those_of_its_options) {
  SolveOptions o;
  o.material.cohesion = 1234;
  const MaterialSettings m = make_settings(o, grid).common.materials;
  EXPECT_EQ(m.in<double>().list[0].shear_modulus, make_material<double>(o.material).shear_modulus);
  EXPECT_EQ(m.in<float>().list[0].shear_modulus, make_material<float>(o.material).shear_modulus);
  EXPECT_FALSE(m.densities_differ);
}

TEST(Settings, gravity_loading_holds_what_yields_and_keeps_the_walls_of_the_start) {
  SolveOptions o;
  o.material.dilatancy_angle = 5;
  o.implicit.newton_iterations = 1;
  o.base.cohesion = 100;
  o.walls = {{.axis = Axis::x}};
  const SolverSettings s = for_gravity_loading(make_settings(o, grid), 8);
  EXPECT_EQ(s.integrator, Integrator::quasi_static);
  EXPECT_FALSE(s.implicit.dynamic);
  EXPECT_EQ(s.implicit.step, 0.125);
  EXPECT_EQ(s.implicit.newton_iterations, 20);
  EXPECT_EQ(s.common.gravity_ramp, 1);
  EXPECT_EQ(s.common.materials.in_double.list[0].model, MaterialModel::hencky);
  EXPECT_EQ(s.common.materials.in_single.list[0].model, MaterialModel::hencky);
  EXPECT_FALSE(s.common.needs.plastic_volume);
  EXPECT_EQ(s.common.bed.law, FrictionLaw::stick);
  EXPECT_FALSE(s.common.bed.has_traction());
  ASSERT_EQ(s.common.walls.size(), 1U);
  EXPECT_EQ(s.common.walls[0].to, 2) << "they stand throughout";
}

TEST(ImplicitControls, are_those_of_the_recipe) {
  SolveOptions o = stepping_by(Integrator::newmark);
  o.implicit = {.step = 0.03,
                .newmark = {0.5, 1},
                .newton_tolerance = 1e-4,
                .linear_solver = LinearSolver::cholesky,
                .linear_tolerance = 1e-5,
                .b_bar = true,
                .newton_iterations = 7,
                .forcing = Forcing::fixed,
                .linear_iterations = 77,
                .step_cuts = 3};
  const ImplicitControls c = make_settings(o, grid).implicit;
  EXPECT_TRUE(c.dynamic);
  EXPECT_EQ(c.step, 0.03);
  EXPECT_EQ(c.step_cuts, 3);
  EXPECT_EQ(c.alpha, 0.5);
  EXPECT_EQ(c.beta, 1);
  EXPECT_EQ(c.newton_iterations, 7);
  EXPECT_EQ(c.tolerance, 1e-4);
  EXPECT_EQ(c.forcing, Forcing::fixed);
  EXPECT_EQ(c.linear_tolerance, 1e-5);
  EXPECT_EQ(c.linear_solver, LinearSolver::cholesky);
  EXPECT_EQ(c.linear_iterations, 77);
  EXPECT_TRUE(c.b_bar);
  EXPECT_EQ(c.give_up, interrupted) << "a step ends where a signal asks for the end";
}

TEST(ImplicitControls, are_static_and_one_linear_solve_where_the_recipe_says_so) {
  SolveOptions o = stepping_by(Integrator::quasi_static);
  EXPECT_FALSE(make_settings(o, grid).implicit.dynamic);
  EXPECT_FALSE(make_settings(o, grid).implicit.once());
  o.implicit.newton_iterations = 1;
  EXPECT_TRUE(make_settings(o, grid).implicit.once());
}

TEST(ImplicitControls, of_what_flows_are_damped_and_loose_where_the_recipe_leaves_them_open) {
  SolveOptions o = stepping_by(Integrator::newmark);
  const ImplicitControls flow = make_settings(o, grid).implicit;
  EXPECT_EQ(flow.alpha, 0.5);
  EXPECT_EQ(flow.beta, 1);
  EXPECT_EQ(flow.tolerance, 1e-2);
  const auto is_exact = [](const SolveOptions& options) {
    const ImplicitControls c = make_settings(options, grid).implicit;
    return c.alpha == 0.25 && c.beta == 0.5 && c.tolerance == 1e-6;
  };
  o.integrator = Integrator::quasi_static;
  EXPECT_TRUE(is_exact(o)) << "statics";
  o.integrator = Integrator::automatic;
  EXPECT_TRUE(is_exact(o)) << "at rest";
  o.integrator = Integrator::newmark;
  o.material.model = MaterialModel::hencky;
  EXPECT_TRUE(is_exact(o)) << "an elastic body";
}

}  // namespace
}  // namespace talus::solver::testing
