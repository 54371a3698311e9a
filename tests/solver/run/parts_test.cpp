// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes of several materials, and materials that soften.
#include <unistd.h>

#include "solver/run/simulation.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

class Parts : public InEachPlace {
 protected:
  /// Two blocks apart from one another, each a release.
  static Domain two_blocks() {
    Domain d = ground(24, 12, 1.0, 1.0, [](double, double) { return 0.0; });
    fill(d, {4, 8, 4, 8, 0, 4});
    const std::size_t first = d.points.size();
    fill(d, {14, 18, 4, 8, 0, 4});
    std::fill(d.points.release.begin() + static_cast<std::ptrdiff_t>(first), d.points.release.end(), 1);
    d.release_names = {"body", "other"};
    return d;
  }

  static SolveOptions elastic() {
    SolveOptions o;
    o.material.model = MaterialModel::hencky;
    o.material.youngs_modulus = 4e6;
    o.material.density = 1000;
    o.base.law = FrictionLaw::stick;
    o.gravity_ramp = 0.5;
    o.damping = 0.2;
    return o;
  }

  /// Mean height of the points of each release.
  static std::array<double, 2> heights(const Solver& solver, const Scene& scene) {
    const ParticleState s = solver.state().points;
    const auto x = positions(scene, s);
    std::array<double, 2> sum{}, count{};
    for (std::size_t p = 0; p < s.size(); ++p) {
      const auto r = static_cast<std::size_t>(s.release[p]);
      sum[r] += x[p][2];
      count[r] += 1;
    }
    return {sum[0] / count[0], sum[1] / count[1]};
  }
};

TEST_P(Parts, give_each_release_its_own_material) {
  // The other block is twice as heavy and eight times as stiff: it settles a quarter as far. Both integrators.
  const Domain d = two_blocks();
  for (const auto integrator : {Integrator::explicit_, Integrator::newmark, Integrator::quasi_static}) {
    SolveOptions o = elastic();
    o.integrator = integrator;
    o.implicit.step = integrator == Integrator::quasi_static ? 0.25 : 0.01;
    o.parts.resize(1);
    o.parts[0].release = "other";
    o.parts[0].material = o.material;
    o.parts[0].material.youngs_modulus *= 8;
    o.parts[0].material.density *= 2;
    const Scene scene = make_scene(d, o);
    const auto solver = make_solver(scene, o, GetParam());
    const auto before = heights(*solver, scene);
    run_to(*solver, 1.5);
    const auto after = heights(*solver, scene);
    EXPECT_GT(before[0] - after[0], 0.01);
    EXPECT_NEAR((before[1] - after[1]) / (before[0] - after[0]), 0.25,
                0.25 * 0.03);  // strains of 1 % are not quite linear
    // Maps take volume, not mass.
    const auto peak = solver->state().maps.peak_thickness;
    const double first = peak[d.grid.index(6, 6)], second = peak[d.grid.index(16, 6)];
    EXPECT_NEAR(second, first, 0.05 * first);
    EXPECT_NEAR(first, 4, 0.5);
  }
}

TEST_P(Parts, change_nothing_where_they_are_the_same) {
  const Domain d = two_blocks();
  SolveOptions o = elastic();
  o.material.model = MaterialModel::drucker_prager;
  o.material.youngs_modulus = 1e6;
  o.base.law = FrictionLaw::coulomb;
  o.gravity_ramp = 0;
  const auto run = [&](const SolveOptions& options) {
    const Scene scene = make_scene(d, options);
    const auto solver = make_solver(scene, options, GetParam());
    run_to(*solver, 1);
    return heights(*solver, scene);
  };
  const auto one = run(o);
  o.parts.resize(1);
  o.parts[0].release = "other";
  o.parts[0].material = o.material;
  const auto two = run(o);
  const double tolerance = GetParam() == On::cpu ? 0 : 1e-6;  // sums in another order
  EXPECT_NEAR(one[0], two[0], tolerance);
  EXPECT_NEAR(one[1], two[1], tolerance);
}

TEST_P(Parts, soften_as_they_slip) {
  // Cohesion that holds a steep block, and none left after a decimetre of slip: the block stands where it does not
  // soften, and falls apart where it does, nearly as one that never had any.
  const auto height_after = [&](double cohesion, double slip) {
    Domain d = ground(24, 20, 1.0, 1.0, [](double, double) { return 0.0; });
    fill(d, {10, 14, 8, 12, 0, 6});
    SolveOptions o;
    o.material.youngs_modulus = 1e7;
    o.material.cohesion = cohesion;
    o.material.cone = Cone::compression;
    o.material.friction_angle = 25;
    o.material.softening_slip = slip;
    o.material.residual_friction_angle = 25;
    o.base.law = FrictionLaw::stick;
    return SceneRun(d, o, GetParam()).at(3).z;
  };
  EXPECT_GT(height_after(2.5e4, 0), 2.8);
  const double loose = height_after(0, 0), softened = height_after(2.5e4, 0.1);
  EXPECT_LT(softened, 1.5);
  EXPECT_GT(softened, loose);
  EXPECT_LT(softened, loose + 0.4);
}

/// A sheet of ground on a slope and below it, where wanted with a slide that comes down on it.
Domain erodible_ground(bool slide) {
  Domain d = ground(120, 16, 1.0, 0.5, [](double x, double) { return x < 40 ? 0.6 * (40 - x) : 0.0; });
  fill(d, {24, 34, 5, 11, 0, 0.5});  // a sheet of ground, as thick as a layer
  const std::size_t sheet = d.points.size();
  if (slide) fill(d, {6, 12, 5, 11, 0, 3});
  std::fill(d.points.release.begin() + static_cast<std::ptrdiff_t>(sheet), d.points.release.end(), 1);
  d.release_names = {"ground", "slide"};
  d.erodible = 1;
  return d;
}

/// Ground of a strength of its own that it loses as it slips, on a base that holds what rests.
SolveOptions erodible_options() {
  SolveOptions o;
  o.end_time = 6;
  o.frame_interval = 6;
  o.base.friction_angle = 12;
  o.gravity_loading_steps = 4;
  o.base.cohesion = 0;
  o.parts.resize(1);
  o.parts[0].release = "ground";
  o.parts[0].material.cohesion = 5000;
  o.parts[0].material.softening_slip = 0.3;
  o.parts[0].material.residual_friction_angle = 20;
  o.base.law = FrictionLaw::velocity_weakening;
  o.base.peak_coefficient = 0.8;  // holds the sheet at rest on a slope of 0.6
  o.base.steady_coefficient = 0.2;
  o.base.characteristic_speed = 0.5;
  return o;
}

talus::Run run_erodible(bool slide, const std::filesystem::path& folder) {
  const RunPaths paths(folder);
  std::filesystem::create_directories(folder);
  const Domain domain = erodible_ground(slide);
  const SolveOptions options = erodible_options();
  Simulation simulation(drafted(domain, options), CpuDevice::make(), paths, "");
  simulation.run("erodible", "Erodible ground");
  return read_run(paths.run);
}

/// Of what lies on a map with cells of 1 m2.
double volume_on(const std::vector<double>& thickness) {
  double sum = 0;
  for (const double t : thickness) sum += std::isfinite(t) ? t : 0;
  return sum;
}

/// Entrainment: ground of its own strength rests until a slide comes, and what it takes along is told from what stays.
TEST(ErodibleGround, rests_until_it_is_loaded_and_is_told_apart) {
  const auto folder = std::filesystem::temp_directory_path() / ("talus-erodible-" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder);
  const talus::Run calm = run_erodible(false, folder / "calm");
  EXPECT_EQ(calm.summary.volume_entrained, 0);
  EXPECT_NEAR(volume_on(calm.maps.deposit_thickness), 0, 1e-9);
  EXPECT_NEAR(volume_on(calm.maps.eroded_depth), 0, 0.02 * 30);
  const talus::Run swept = run_erodible(true, folder / "swept");
  const RunSummary& s = swept.summary;
  EXPECT_NEAR(s.volume_released, 6 * 6 * 3, 1e-9);
  EXPECT_GT(s.volume_entrained, 3);
  EXPECT_NEAR(s.volume_released + s.volume_entrained, s.volume_final + s.volume_outflow, 1e-9);
  EXPECT_NEAR(volume_on(swept.maps.deposit_thickness), s.volume_final, 1e-6);
  ASSERT_EQ(swept.maps.deposit_of.size(), 2U);
  EXPECT_NEAR(volume_on(swept.maps.deposit_of[0].second) + volume_on(swept.maps.deposit_of[1].second), s.volume_final,
              1e-6);
  const double ground_left = volume_on(swept.maps.deposit_of[0].second);  // some of it may have left the domain
  EXPECT_LE(ground_left, s.volume_entrained + 1e-6);
  EXPECT_GE(ground_left, s.volume_entrained - s.volume_outflow - 1e-6);
  EXPECT_NEAR(volume_on(swept.maps.initial_thickness), s.volume_released, 1e-6);
  std::filesystem::remove_all(folder);
}

TEST(PartsOfAScene, need_a_release_of_that_name) {
  Domain d = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 8, 4, 8, 0, 4});
  SolveOptions o;
  o.parts.resize(1);
  o.parts[0].release = "nowhere";
  EXPECT_THROW(make_scene(d, o), RecipeError);
}

TEST(Softening, falls_from_peak_to_residual_over_the_slip_whatever_the_cell) {
  SolveOptions o;
  o.material.cohesion = 1e4;
  o.material.friction_angle = 35;
  o.material.softening_slip = 0.2;
  o.material.residual_friction_angle = 20;
  for (const double cell : {0.5, 2.0}) {
    const Material<double> m = make_materials<double>(o, 4, cell).list[0];
    MaterialOptions left = o.material;
    left.friction_angle = 20;
    left.cohesion = 0;
    const Material<double> residual = make_material<double>(left);
    for (const double share : {0.0, 0.5, 1.0, 3.0}) {
      const Material<double> now = softened(m, share * o.material.softening_slip / cell);
      const double way = std::min(share, 1.0);
      EXPECT_NEAR(now.friction, m.friction + way * (residual.friction - m.friction), 1e-14);
      EXPECT_NEAR(now.shear_cohesion, (1 - way) * m.shear_cohesion, 1e-9);
    }
  }
  // A simple shear strain adds what a slip over a cell of that thickness makes: d(plastic) = dgamma / sqrt(3), once the
  // elastic part is over.
  MaterialOptions plain;
  plain.friction_angle = 30;
  const Material<double> m = make_material<double>(plain);
  MaterialState<double> s;
  s.log_volume = -0.01;
  double sum = 0;
  for (int step = 0; step < 4000; ++step) {
    Mat3<double> g{};
    g.c.x = 1e-3;  // d u_x / d z
    s.plastic_shear = 0;
    advance_material(m, g, 0.01, s);
    if (step >= 2000) sum += s.plastic_shear;
  }
  EXPECT_NEAR(sum, 2.0 / std::sqrt(3.0), 0.02 * 2.0 / std::sqrt(3.0));
}

TALUS_IN_EACH_PLACE(Parts);

}  // namespace
}  // namespace talus::solver::testing
