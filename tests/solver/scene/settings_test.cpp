// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From domain and recipe to a scene and its settings: points, units, laws, solvers that fall freely, accelerograms.
#include <cmath>
#include <numbers>

#include "common/stage/stage.hpp"
#include "common/table_words.hpp"
#include "solver/boundary/contact_points.hpp"
#include "solver/column_implicit/column_implicit_solver.hpp"
#include "solver/integrator/make_solvers.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/options/implicit.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/material.hpp"
#include "solver/options/scheme.hpp"
#include "solver/scene/settings.hpp"
#include "solver/scene/tables.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/expect.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

using test::fault_of;

/// Four points in the cells about (5, 5), two layers high, on a slope.
Domain sample() {
  Domain domain = testing::ground(30, 20, 10, 5, [](double x, double) { return 0.3 * x; });
  testing::fill(domain, {50, 60, 50, 60, 0, 10}, 1, 1);
  domain.active = active_cells(domain.grid, domain.layer_height, domain.points);
  return domain;
}

TEST(MakeScene, the_mask_of_the_file_is_the_grid_at_the_start) {
  const Domain domain = sample();
  EXPECT_EQ(make_scene(domain, {}).active, *domain.active);
  Domain made_in_memory = domain;
  made_in_memory.active.reset();
  EXPECT_EQ(make_scene(made_in_memory, {}).active, *domain.active);
}

TEST(MakeScene, every_node_next_to_a_point_is_active) {
  const Scene scene = make_scene(sample(), {});
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    for (int beside = 0; beside < 27; ++beside) {
      const int layer = scene.points.cell[2][p] + beside / 9 - 1;
      EXPECT_EQ(scene.active.holds(
                    {scene.points.cell[0][p] + beside % 3 - 1, scene.points.cell[1][p] + beside / 3 % 3 - 1, layer}),
                layer >= 0);
    }
  }
}

TEST(MakeScene, points_outside_the_active_cells_are_refused) {
  Domain domain = sample();
  domain.points.height[1] = 40;
  EXPECT_EQ(
      fault_of<DataError>([&] { make_scene(domain, {}); }),
      "domain.vdb: point 1 at (55.00, 55.00), 40.00 m above the bed, lies in column 5, row 5, layer 8, which is no "
      "active cell of the background grid (points and mask \"active\" are not of one domain). Run "
      "talus-preprocess again");
  domain = sample();
  domain.points.x[0] = 215;
  EXPECT_TRUE(
      test::holds(fault_of<DataError>([&] { make_scene(domain, {}); }), {"lies in column 21, row 5, layer 1,"}));
}

TEST(MakeScene, points_at_the_edge_of_the_ground_are_refused) {
  Domain domain = sample();
  domain.points.x[0] = 2;
  EXPECT_EQ(fault_of<DataError>([&] { make_scene(domain, {}); }),
            "domain.vdb: point 0 at (2.00, 55.00) stands outside the ground or at its edge (a point needs known ground "
            "one cell around it). Give a larger elevation model, or a smaller source, and run talus-preprocess again");
}

/// `rounding` is the relative error that speed and place may have.
template <class Real, class Shape>
void expect_free_fall(SolveOptions o, On on, double rounding) {
  o.shape = kind_of<Shape>;
  const Scene scene = make_scene(filled(ground(12, 12, 1.0, 1.0, flat), {4, 8, 4, 8, 5, 8}), o);
  const SolverSettings settings = make_settings(o, scene.grid);
  const SolverState start = first_state(scene, settings.common);
  const AnyDevice device = make_device(on);
  const auto solver =
      o.integrator == Integrator::explicit_ ? ExplicitSolvers<Real, Shape>::make(scene, settings.common, device, start)
      : o.integrator == Integrator::column_implicit
          ? ColumnImplicitSolvers<Real, Shape>::make(scene, settings.common, device, start)
          : ImplicitSolvers<Real, Shape>::make(scene, settings.common, settings.implicit, device, start);
  EXPECT_EQ(solver->particle_count(), static_cast<int>(scene.points.size()));
  run_to(*solver, 0.2);
  const Centre c = centre(*solver, scene);
  EXPECT_NEAR(c.speed, 9.81 * 0.2, rounding * 9.81 * 0.2);
  EXPECT_NEAR(c.x, 6, 6 * rounding);
}

class FreeFall : public InEachPlace {};
TALUS_IN_EACH_PLACE(FreeFall);

// Every step rounds velocities once in the precision of the points; there are some hundred of them.
TEST_P(FreeFall, is_that_of_explicit_steps) {
  SolveOptions o = stepping_by(Integrator::explicit_);
  expect_free_fall<double, Linear>(o, GetParam(), 1e-12);
  expect_free_fall<double, Quadratic>(o, GetParam(), 1e-12);
  expect_free_fall<float, Gimp>(o, GetParam(), 1e-4);
}

TEST_P(FreeFall, is_that_of_column_implicit_steps) {
  SolveOptions o = stepping_by(Integrator::column_implicit);
  expect_free_fall<double, Quadratic>(o, GetParam(), 1e-12);
  expect_free_fall<float, Gimp>(o, GetParam(), 1e-4);
  o.stress_update = StressUpdate::modified;
  expect_free_fall<double, Linear>(o, GetParam(), 1e-12);
}

// Newton leaves a millionth of the forces unbalanced (newton_tolerance), and single precision rounds at 1e-7.
TEST_P(FreeFall, is_that_of_implicit_steps) {
  SolveOptions o = stepping_by(Integrator::newmark);
  o.implicit.step = 0.05;
  o.implicit.newton_tolerance = 1e-6;
  expect_free_fall<double, Linear>(o, GetParam(), 1e-6);
  expect_free_fall<double, Quadratic>(o, GetParam(), 1e-6);
  expect_free_fall<float, Gimp>(o, GetParam(), 1e-5);
}

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

TEST(Settings, shallow_columns_are_those_below_a_cell_unless_the_recipe_says_otherwise) {
  SolveOptions o;
  EXPECT_EQ(make_settings(o, grid).common.separation.kind, Separation::free);
  o.base.separation = Separation::thin;
  EXPECT_EQ(make_settings(o, grid).common.separation.depth, grid.spacing);
  o.base.separation_depth = 7;
  EXPECT_EQ(make_settings(o, grid).common.separation.depth, 7);
  EXPECT_EQ(for_gravity_loading(make_settings(o, grid), 3).common.separation.kind, Separation::free);
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

/// The options that name a file of this text.
struct ShakingFile {
  test::Scratch scratch;
  ShakingOptions options;
  explicit ShakingFile(const std::string& text) { options.file = scratch.write("record.csv", text); }

  Shaking read() const { return read_shaking(options); }
  /// The refusal, without the folder.
  std::string refusal() const {
    std::string text = test::fault_of<DataError>([&] { read(); });
    const std::string folder = scratch.folder().string() + "/";
    while (text.find(folder) != std::string::npos) text.erase(text.find(folder), folder.size());
    return text;
  }
};

TEST(ReadShaking, takes_columns_by_name_in_any_order) {
  const Shaking shaking = ShakingFile(
                              "# station X, 2026\n"
                              "up, time_s; \"North\"\tEAST\r\n"
                              "0.5, 3.0, -1, +2e0\n"
                              "\n"
                              "0.25, 3.5, 1, 4   # the last one\n")
                              .read();
  ASSERT_EQ(shaking.samples.size(), 2u);
  EXPECT_EQ(shaking.samples[0].time, 0) << "the first row acts at start_s";
  EXPECT_EQ(shaking.samples[1].time, 0.5);
  expect_near(shaking.samples[0].acceleration, {2, -1, 0.5}, 0);
  EXPECT_DOUBLE_EQ(shaking.samples[1].velocity.x, 1.5);
}

TEST(ReadShaking, brings_units_scale_and_start_to_the_run) {
  ShakingFile file("time_s,east\n0,1\n0.1,-1\n");
  file.options.unit = ShakingUnit::g;
  file.options.scale = -0.5;
  file.options.start = 7;
  EXPECT_DOUBLE_EQ(file.read().samples[0].acceleration.x, -0.5 * 9.80665);
  EXPECT_EQ(file.read().samples[0].time, 7);
  EXPECT_DOUBLE_EQ(file.read().samples[1].time, 7.1);
  file.options.unit = ShakingUnit::cm_s2;
  EXPECT_DOUBLE_EQ(file.read().samples[1].acceleration.x, 0.005);
}

TEST(ReadShaking, turns_components_along_an_azimuth_to_the_map) {
  ShakingFile file("time_s along across up\n0 2 3 5\n1 0 0 0\n");
  const auto first = [&](double azimuth) {
    file.options.azimuth = azimuth;
    return file.read().samples[0].acceleration;
  };
  EXPECT_NEAR(first(0).x, 3, 1e-15);  // along points north, across east
  EXPECT_NEAR(first(0).y, 2, 1e-15);
  EXPECT_NEAR(first(90).x, 2, 1e-15);  // along east, across south
  EXPECT_NEAR(first(90).y, -3, 1e-15);
  EXPECT_EQ(first(90).z, 5);
}

TEST(ReadShaking, no_file_is_ground_that_rests) { EXPECT_FALSE(read_shaking({}).acts()); }

TEST(ReadShaking, what_is_no_accelerogram_is_refused_with_its_line) {
  constexpr const char* name_them =
      "Name the columns in the first line: time_s and some of east, north, up; or time_s and some of along, across, "
      "up, "
      "with azimuth_deg in [solve.shaking]";
  const auto refusal = [](const std::string& text) { return ShakingFile(text).refusal(); };
  EXPECT_EQ(refusal("0 1\n1 2\n"), std::string("record.csv: line 1: \"0\" (it is no name of a column). ") + name_them);
  EXPECT_EQ(refusal("time_s east_g\n"),
            std::string("record.csv: line 1: \"east_g\" (it is no name of a column). ") + name_them);
  EXPECT_EQ(refusal("time_s\n0\n1\n"),
            std::string("record.csv: line 1: no time_s with an acceleration (both are needed). ") + name_them);
  EXPECT_EQ(refusal("time_s up up\n"),
            std::string("record.csv: line 1: two columns \"up\" (only one can act). ") + name_them);
  EXPECT_EQ(refusal("time_s east along\n"),
            std::string("record.csv: line 1: columns along and across beside east and north (they are the same). ") +
                name_them);
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 1 2\n"),
            "record.csv: line 3: 3 words (the first line names 2 columns). Mend the line");
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 nan\n"),
            "record.csv: line 3: \"nan\" (it is no finite number). Mend the line");
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 1e999\n"),
            "record.csv: line 3: \"1e999\" (it is no finite number). Mend the line");
  EXPECT_EQ(refusal("time_s east\n0 1\n0.1 1\n0.1 2\n"),
            "record.csv: line 4: time_s = 0.1 (times must grow from row to row). Sort the rows, and leave out those of "
            "the same time");
  EXPECT_EQ(refusal("time_s east\n0 1\n"), "record.csv (it has 1 rows of numbers). An accelerogram has two at least");
  EXPECT_EQ(refusal("time_s east\n0 1e308\n10 1e308\n"),
            "record.csv (the velocity of the ground is beyond all numbers). Check its unit and its scale");
}

TEST(ReadShaking, an_azimuth_belongs_to_columns_along_it) {
  ShakingFile turned("time_s along\n0 1\n1 0\n");
  EXPECT_EQ(turned.refusal(),
            "record.csv: line 1: columns along or across (it is not said where they point). Give [solve.shaking] "
            "azimuth_deg, the direction of along from north over east");
  ShakingFile mapped("time_s east\n0 1\n1 0\n");
  mapped.options.azimuth = 30;
  EXPECT_EQ(mapped.refusal(),
            "record.csv: line 1: no column along or across (azimuth_deg would have no effect). Leave [solve.shaking] "
            "azimuth_deg out, or name the columns by it");
}

TEST(ReadShaking, a_missing_file_is_named) {
  ShakingFile file("");
  file.options.file = file.scratch / "nothing.csv";
  EXPECT_EQ(file.refusal(), "nothing.csv: cannot be opened (missing or not readable). Check [solve.shaking] file");
}

TEST(TableWords, are_parted_by_any_separator_and_lose_case_quotes_and_comments) {
  using Words = std::vector<std::string>;
  EXPECT_EQ(table_words("Time_s;\"East\", north\tup # g\r"), (Words{"time_s", "east", "north", "up"}));
  EXPECT_TRUE(table_words("  # nothing").empty());
}

TEST(TableWords, are_numbers_where_they_are_finite_ones) {
  EXPECT_EQ(signed_number("+1.5e3"), 1500);
  EXPECT_EQ(signed_number("-2"), -2);
  for (const char* word : {"", "1,5", "nan", "inf", "1e999", "two", "1x"}) EXPECT_FALSE(signed_number(word)) << word;
}

TEST(PlaceInCells, is_the_nearest_node_and_what_is_left) {
  int cell = 0;
  double offset = 0;
  place_in_cells(4.75, cell, offset);
  EXPECT_EQ(cell, 5);
  EXPECT_EQ(offset, -0.25);
  place_in_cells(4.5, cell, offset);
  EXPECT_EQ(cell, 5);
  EXPECT_EQ(offset, -0.5);
}

}  // namespace
}  // namespace talus::solver::testing
