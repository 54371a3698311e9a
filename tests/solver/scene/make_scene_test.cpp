// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points of a domain in a scene, and solvers of it that fall freely.
#include "solver/scene/make_scene.hpp"
#include "solver/column_implicit/column_implicit_solver.hpp"
#include "solver/integrator/make_solvers.hpp"
#include "solver/scene/settings.hpp"
#include "tests/common/scratch.hpp"
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

TEST(MakeScene, a_raster_of_mu_gives_the_angle_of_a_law_that_has_one) {
  Domain d = filled(ground(12, 12, 10, 5, flat), {40, 60, 40, 60, 0, 5});
  Raster mu{d.grid, std::vector<double>(d.grid.count(), 0.3)};
  mu.at(2, 3) = std::nan("");  // the recipe's angle holds there
  d.bed.emplace_back("friction_coefficient", mu);
  SolveOptions o;
  o.base.friction_angle = std::atan(0.2) / degree;
  const auto frictions = [&](FrictionLaw law) {
    o.base.law = law;
    std::vector<double> all;
    for (const Bed<double>& bed : make_scene(d, o).bed) all.push_back(bed.numbers[0]);
    return all;
  };
  for (const FrictionLaw law : {FrictionLaw::coulomb, FrictionLaw::voellmy}) {
    const std::vector<double> found = frictions(law);
    EXPECT_NEAR(found[d.grid.index(2, 3)] / found[0], 0.2 / 0.3, 1e-12);
  }
  EXPECT_NO_THROW(frictions(FrictionLaw::samosat));
  EXPECT_TRUE(test::holds(test::fault_of<RecipeError>([&] { frictions(FrictionLaw::none); }),
                          {"friction_coefficient", "does not use it"}));
}

/// The numbers of the bed in every cell for a law, with a raster of 0.3 and 0.4 under this name.
std::vector<double> bed_with(FrictionLaw law, const std::string& name, double west, double east) {
  Domain d = filled(ground(12, 12, 10, 5, flat), {40, 60, 40, 60, 0, 5});
  Raster raster{d.grid, std::vector<double>(d.grid.count(), west)};
  for (int row = 0; row < d.grid.rows; ++row) raster.at(9, row) = east;
  d.bed.emplace_back(name, raster);
  SolveOptions o;
  o.base.law = law;
  std::vector<double> all;
  for (const Bed<double>& bed : make_scene(d, o).bed)
    all.insert(all.end(), std::begin(bed.numbers), std::end(bed.numbers));
  return all;
}

TEST(MakeScene, rasters_of_either_form_make_one_bed_with_every_law) {
  const auto angle = [](double mu) { return std::atan(mu) / degree; };
  const auto xi = [](double k) { return SolveOptions{}.gravity_size() / k; };
  const auto expect_one = [](const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t n = 0; n < a.size(); ++n) EXPECT_NEAR(a[n], b[n], 1e-14 * std::abs(b[n]));
  };
  for (const FrictionLaw law : {FrictionLaw::coulomb, FrictionLaw::voellmy, FrictionLaw::samosat})
    expect_one(bed_with(law, "friction_coefficient", 0.3, 0.4),
               bed_with(law, "friction_angle_deg", angle(0.3), angle(0.4)));
  for (const char* number : {"stop", "steepest", "start"})
    expect_one(bed_with(FrictionLaw::pouliquen, std::string(number) + "_coefficient", 0.5, 0.55),
               bed_with(FrictionLaw::pouliquen, std::string(number) + "_angle_deg", angle(0.5), angle(0.55)));
  expect_one(bed_with(FrictionLaw::voellmy, "drag_coefficient", 0.004, 0.01),
             bed_with(FrictionLaw::voellmy, "turbulence_m_s2", xi(0.004), xi(0.01)));
  EXPECT_TRUE(
      test::holds(test::fault_of<RecipeError>([&] { bed_with(FrictionLaw::coulomb, "drag_coefficient", 1, 1); }),
                  {"drag_coefficient", "does not use it"}));
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
