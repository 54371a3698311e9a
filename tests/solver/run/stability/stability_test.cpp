// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Factor of safety against closed forms and a published slope: the search, its trials, the mass that fails, its files.
#include "solver/run/stability/stability.hpp"
#include "common/stage/context.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/stability/stability_stage.hpp"
#include "solver/run/stability/weaken.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

FactorBracket bracket_of(double limit, double tolerance = 0.005) {
  return bracket_factor([&](double factor) { return factor <= limit; }, {.tolerance = tolerance});
}

TEST(FactorSearch, encloses_a_limit_above_and_below_one_within_the_tolerance) {
  for (const double limit : {0.0723, 0.4, 0.999, 1.0, 1.001, 1.38, 7.3, 19.9}) {
    const FactorBracket found = bracket_of(limit);
    EXPECT_LE(found.low, limit);
    EXPECT_GT(found.high, limit);
    EXPECT_LE(found.high - found.low, 0.005 * found.low) << limit;
    EXPECT_TRUE(found.closed());
  }
}

TEST(FactorSearch, says_when_all_or_none_held) {
  const FactorBracket all = bracket_of(1e9), none = bracket_of(1e-9);
  EXPECT_EQ(all.low, 20);
  EXPECT_TRUE(std::isinf(all.high));
  EXPECT_EQ(none.low, 0);
  EXPECT_EQ(none.high, 0.01);
  EXPECT_FALSE(all.closed() || none.closed());
}

TEST(FactorSearch, goes_on_from_what_is_known) {
  std::vector<double> tried;
  const FactorBracket found = bracket_factor([&](double factor) { return tried.push_back(factor), factor <= 2; },
                                             {.tolerance = 0.005}, {.low = 1.6});
  EXPECT_LE(found.low, 2);
  EXPECT_GT(found.high, 2);
  EXPECT_EQ(tried.front(), 1.02 * 1.6) << "neither 1 again nor below what held: what is known may be near the limit";
  EXPECT_LT(tried.size(), 14U) << "and it may be far from it";
}

TEST(FactorSearch, tries_no_more_often_than_the_bracket_asks_for) {
  int tries = 0;
  bracket_factor([&](double factor) { return ++tries, factor <= 1.38; }, {.tolerance = 0.005});
  EXPECT_LE(tries, 3 + 6);  // 1, 1.25, 1.56; six halvings of 0.31 are below 0.005 of 1.38
}

double tangent_of(double degrees) { return std::tan(degrees * std::numbers::pi / 180); }

TEST(Weaken, divides_the_tangent_and_the_cohesion_of_every_material) {
  SolveOptions o;
  o.material.friction_angle = 35;
  o.material.cohesion = 1200;
  o.material.dilatancy_angle = 30;
  o.parts.resize(2);
  o.parts[0].material.friction_angle = 20;
  o.parts[0].material.cohesion = 300;
  o.parts[1].material.model = MaterialModel::hencky;
  o.parts[1].material.friction_angle = 20;
  const SolveOptions weak = weakened(o, 1.5);
  EXPECT_NEAR(tangent_of(weak.material.friction_angle), tangent_of(35) / 1.5, 1e-12);
  EXPECT_NEAR(weak.material.cohesion, 800, 1e-9);
  EXPECT_EQ(weak.material.dilatancy_angle, weak.material.friction_angle) << "flow would make energy";
  EXPECT_NEAR(tangent_of(weak.parts[0].material.friction_angle), tangent_of(20) / 1.5, 1e-12);
  EXPECT_NEAR(weak.parts[0].material.cohesion, 200, 1e-9);
  EXPECT_EQ(weak.parts[1].material.friction_angle, 20) << "an elastic body has no strength";
}

TEST(Weaken, divides_friction_and_cohesion_of_the_bed_everywhere) {
  SolveOptions o;
  o.base.friction_angle = 30;
  o.base.cohesion = 500;
  const BaseFriction<double> bed = make_base_friction<double>(o), weak = weakened(bed, 2);
  EXPECT_NEAR(weak.uniform.numbers[Coulomb::mu], tangent_of(30) / 2, 1e-12);
  EXPECT_NEAR(weak.uniform.cohesion, 250, 1e-9);
  const auto columns = weakened(std::vector<Bed<double>>(3, bed.uniform), bed.law, 2);
  ASSERT_EQ(columns.size(), 3U);
  EXPECT_NEAR(columns[2].numbers[Coulomb::mu], tangent_of(30) / 2, 1e-12);
  EXPECT_NEAR(columns[2].cohesion, 250, 1e-9);
}

TEST(Weaken, stiffens_soft_ground_until_its_weight_strains_it_little) {
  Domain d = filled(ground(8, 8, 1.0, 1.0, flat), {2, 6, 2, 6, 0, 4});
  SolveOptions soft;
  const double speed = make_material<double>(stiffened(soft, stiffening_of(d, soft)).material).wave_speed;
  EXPECT_NEAR(9.81 * 3.75 / (speed * speed), strain_of_searches, 1e-12);  // 3.75 m: the highest point
  soft.material.youngs_modulus = 1e10;
  EXPECT_EQ(stiffening_of(d, soft), 1);
}

/// Points that fill so many cells along each axis, one in each corner cell.
ParticleState corners_of(int nx, int ny, int nz) {
  ParticleState points;
  points.cell[0] = {3, 2 + nx};
  points.cell[1] = {5, 4 + ny};
  points.cell[2] = {0, nz - 1};
  return points;
}

TEST(TrialSettings, call_strips_narrow_and_slopes_of_some_width_not) {
  EXPECT_TRUE(narrow(corners_of(200, 1, 60))) << "one cell wide, 60 high: 2 x 61 nodes in a section";
  EXPECT_FALSE(narrow(corners_of(200, 1, 70)));
  EXPECT_TRUE(narrow(corners_of(1, 200, 30))) << "whatever the axis";
  EXPECT_TRUE(narrow(corners_of(2, 5, 300)));
  EXPECT_FALSE(narrow(corners_of(20, 20, 10)));
  EXPECT_FALSE(narrow({})) << "nothing to factorise";
}

TEST(TrialSettings, factorise_narrow_ground) {
  Scene strip, wide;
  strip.points = corners_of(40, 1, 20);
  wide.points = corners_of(40, 40, 20);
  SolveOptions options;
  EXPECT_EQ(static_settings(options, strip, 1).implicit.linear_solver, LinearSolver::cholesky);
  EXPECT_EQ(static_settings(options, wide, 1).implicit.linear_solver, LinearSolver::pcg);
}

TEST(TrialSettings, bring_on_all_that_acts_from_the_start) {
  Scene scene;
  scene.points = corners_of(4, 4, 4);
  SolveOptions options;
  options.walls.push_back({Axis::x, 0, Side::above});
  options.walls[0].to = 3;
  const SolverSettings rest = static_settings(options, scene, 1.2), fall = falling_settings(options, scene, 1.2, 0.1);
  EXPECT_EQ(rest.integrator, Integrator::quasi_static);
  EXPECT_EQ(rest.common.gravity_ramp, 1);
  EXPECT_GT(rest.common.walls.at(0).to, 1e9) << "it stays";
  EXPECT_EQ(fall.integrator, Integrator::newmark);
  EXPECT_EQ(fall.common.gravity_ramp, 0);
  EXPECT_EQ(fall.implicit.step, 0.1);
  EXPECT_GT(rest.implicit.patience, fall.implicit.patience) << "a step in time can be cut";
  EXPECT_GT(fall.implicit.patience, 0);
}

/// A block that cannot fail in itself on a plane of this slope, 4 x 4 m and 2 m thick along the vertical.
struct BlockOnSlope {
  double slope;
  Domain domain =
      filled(ground(12, 12, 1.0, 1.0, [this](double x, double) { return 100 - slope * x; }), {4, 8, 4, 8, 0, 2});
  SolveOptions options;
  explicit BlockOnSlope(double tangent = tangent_of(20), double tolerance = 0.01) : slope(tangent) {
    options.material.model = MaterialModel::hencky;
    options.base.friction_angle = 30;
    options.stability.factor_of_safety = true;
    options.stability.tolerance = tolerance;
  }
};

/// tan(phi) (1 - r) / tan(beta) + c / (rho g z sin(beta) cos(beta)), of the infinite slope: exact for a block as well.
double infinite_slope(const BlockOnSlope& s, double pore_pressure_ratio, double cohesion) {
  const double c = 1 / std::sqrt(1 + s.slope * s.slope), sine = s.slope * c;
  return tangent_of(30) * (1 - pore_pressure_ratio) / s.slope + cohesion / (2000 * 9.81 * 2 * sine * c);
}

TEST(Stability, of_an_infinite_slope_is_that_of_the_closed_form) {
  for (const auto& [ratio, cohesion] : {std::pair{0.4, 0.0}, {0.25, 6000.0}}) {
    BlockOnSlope s;
    s.options.base.pore_pressure_ratio = ratio;
    s.options.base.cohesion = cohesion;
    StabilitySearch search(s.domain, s.options, CpuDevice::make());
    const Stability found = search.run();
    ASSERT_TRUE(found.factor.closed());
    // The bracket is 1 % wide, its middle within half of that; the rest is the area on which cohesion acts at the rim.
    EXPECT_NEAR(found.factor.middle() / infinite_slope(s, ratio, cohesion), 1, 0.01) << ratio << " " << cohesion;
    EXPECT_TRUE(found.failure.moves);
    const CriticalMass mass = critical_mass(search.scene(), s.options, found.failure);
    EXPECT_NEAR(mass.volume, 4 * 4 * 2, 1e-9) << "all of it goes";
    EXPECT_NEAR(mass.depth, 2, 1e-9);
    EXPECT_NEAR(mass.area, 4 * 4, 1e-9);
    EXPECT_EQ(test::messages_of([&] { warn_of_stability(found, mass); }).size(), 1U) << "that all of it goes";
  }
}

TEST(Stability, of_an_infinite_slope_under_water_in_its_pores) {
  // Full of water of half its density, which flows along the slope; up to half of its depth; with a given share.
  for (const double ratio : {0.5, 0.25, 0.3}) {
    BlockOnSlope s;
    s.options.water.permeability = 1e-10;
    if (ratio == 0.25) s.options.water.table_depth = 1;
    if (ratio == 0.3) s.options.water.pressure_ratio = ratio;
    const Stability found = StabilitySearch(s.domain, s.options, CpuDevice::make()).run();
    ASSERT_TRUE(found.factor.closed());
    EXPECT_NEAR(found.factor.middle() / infinite_slope(s, ratio, 0), 1, 0.01) << ratio;
  }
}

TEST(Stability, level_ground_has_no_factor) {
  BlockOnSlope s(0);
  s.options.stability.largest_factor = 2;
  const Stability found = StabilitySearch(s.domain, s.options, CpuDevice::make()).run();
  EXPECT_FALSE(found.factor.closed());
  EXPECT_EQ(found.factor.low, 2);
  const auto warnings = test::messages_of([&] { warn_of_stability(found, {}); });
  ASSERT_EQ(warnings.size(), 1U);
  EXPECT_NE(warnings[0].find("rests even"), std::string::npos);
}

/// Griffiths & Lane 1999, example 1: 2:1, phi = 20 deg, c = 0.05 rho g H, no dilatancy, a rough base at the toe's
/// level, rollers behind the crest. A strip between rollers, one cell wide.
struct HomogeneousSlope {
  static constexpr double height = 10, crest = 12, cell = 1;
  Domain domain = ground(40, 6, cell, cell, flat);
  SolveOptions options;
  HomogeneousSlope() {
    const double west = 3.5 * cell, south = 2.5 * cell, half = cell / 2;
    for (int n = 0; (n + 0.5) * half < crest + 2 * height; ++n) {
      const double x = (n + 0.5) * half;
      const double top = std::min(height, height - (x - crest) / 2);
      const double left = west + x - half / 2;
      fill_column(left, south, std::round(top / half) * half);
    }
    options.shape = ShapeKind::linear;
    options.material.friction_angle = 20;
    options.material.cohesion = 0.05 * 2000 * 9.81 * height;
    options.material.tension_cutoff = 1e9;
    options.material.cone = Cone::plane_strain;
    options.base.law = FrictionLaw::stick;
    options.walls = {{Axis::x, west, Side::above}, {Axis::y, south, Side::above}, {Axis::y, south + cell, Side::below}};
    options.stability.factor_of_safety = true;
    options.stability.tolerance = 0.03;
  }
  void fill_column(double left, double south, double top) {
    const double half = cell / 2;
    for (int n = 0; (n + 0.5) * half < top; ++n) {
      const double h = (n + 0.5) * half;
      domain.points.x.push_back(left + half / 2);
      domain.points.y.push_back(south + half);
      domain.points.height.push_back(h);
      domain.points.volume.push_back(half * cell * half);
      domain.points.extent_x.push_back(half);
      domain.points.extent_y.push_back(cell);
      domain.points.release.push_back(0);
    }
  }
};

TEST(Stability, of_a_homogeneous_slope_is_that_of_griffiths_and_lane) {
  const HomogeneousSlope s;
  StabilitySearch search(s.domain, s.options, CpuDevice::make());
  const Stability found = search.run();
  ASSERT_TRUE(found.factor.closed());
  EXPECT_TRUE(found.failure.moves);
  // 1.4 there, 1.38 by Bishop & Morgenstern (1960); ten cells over the height are too few for 2 % (validation.md, D1).
  EXPECT_NEAR(found.factor.middle(), 1.39, 0.05 * 1.39);
  const CriticalMass mass = critical_mass(search.scene(), search.options(), found.failure);
  // A slide through the toe: part of the slope, and part of the crest.
  EXPECT_GT(mass.share, 0.15);
  EXPECT_LT(mass.share, 0.8);
  EXPECT_GT(mass.depth, 2);
  const auto thickness = [&](double x) { return mass.thickness[s.domain.grid.index(static_cast<int>(3.5 + x), 2)]; };
  EXPECT_GT(thickness(20), 1) << "in the slope";
  EXPECT_LT(thickness(2), 0.1) << "far behind the crest";
}

/// A vertical cut in clay without friction, which slumps where it fails and rests again.
TEST(Stability, of_a_cut_that_slumps_is_that_of_the_closed_form) {
  HomogeneousSlope s;
  SeedPoints& points = s.domain.points;
  points = {};
  const double half = HomogeneousSlope::cell / 2, west = 3.5 * HomogeneousSlope::cell;
  for (int n = 0; (n + 0.5) * half < 2 * s.height; ++n) s.fill_column(west + n * half, 2.5 * s.cell, s.height);
  s.options.material.friction_angle = 0;
  s.options.material.cohesion = 50000;
  s.options.stability.tolerance = 0.01;
  const Stability found = StabilitySearch(s.domain, s.options, CpuDevice::make()).run();
  ASSERT_TRUE(found.factor.closed());
  // Martin 2011: rho g H / c = 3.7765. What fails is as high as the cut to a cell, and F goes with one over the height.
  const double exact = 3.7765 * 50000 / (2000 * 9.81 * s.height);
  EXPECT_NEAR(found.factor.middle() / exact, 1, s.cell / s.height);
  EXPECT_TRUE(found.failure.moves);
  bool slumped = false;
  for (const StabilityTrial& trial : found.trials) {
    EXPECT_EQ(trial.holds, trial.factor <= found.factor.low) << trial.factor;
    if (trial.holds) {
      EXPECT_LT(trial.way, 0.01 * s.height) << trial.factor;
    } else {
      slumped = slumped || trial.way > 0;
    }
  }
  EXPECT_TRUE(slumped) << "a trial of this scene ends in another shape";
}

TEST(Stability, is_refused_where_there_is_nothing_to_divide) {
  const auto faults_of = [](SolveOptions options) {
    std::vector<Fault> faults;
    recipe::find_unmet(options, faults);
    return faults;
  };
  SolveOptions o;
  o.stability.factor_of_safety = true;
  EXPECT_TRUE(faults_of(o).empty());
  using Options = SolveOptions;
  for (const auto change :
       {+[](Options& one) { one.material.model = MaterialModel::hencky, one.base.law = FrictionLaw::stick; },
        +[](Options& one) { one.material.softening_slip = 1; },
        +[](Options& one) { one.material.model = MaterialModel::mu_of_i; },
        +[](Options& one) { one.material.model = MaterialModel::corotated; },
        +[](Options& one) { one.base.law = FrictionLaw::voellmy; },
        +[](Options& one) { one.shaking.file = "record.csv"; },
        +[](Options& one) { one.stability = {}, one.stability.tolerance = 0.01; }}) {
    SolveOptions refused = o;
    change(refused);
    const auto faults = faults_of(refused);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_NE(faults[0].what.find("[solve.stability]"), std::string::npos);
  }
}

namespace fs = std::filesystem;

/// A block of 2 m on a plane that falls by a quarter, on a bed of 30 degrees.
class StabilityStage : public ::testing::Test {
 protected:
  Facts found() { return find_stability(context_, block_.options, make_device(On::cpu), block_.domain); }

  test::Scratch scratch_;
  BlockOnSlope block_{0.25, 0.1};
  StageContext context_{recipe::Recipe(scratch_.write("recipe.toml", "[scene]\nname = \"block\"\n")), scratch_.folder(),
                        false, "test"};
};

TEST_F(StabilityStage, says_what_the_domain_was_warned_of_where_it_is_checked) {
  block_.domain.findings = {test::finding(Severity::warning, "coarse-grid", "the grid is coarse")};
  context_.check_only = true;
  EXPECT_EQ(test::findings_of([&] { found(); }), block_.domain.findings);
}

TEST_F(StabilityStage, writes_the_factor_and_the_ground_at_rest) {
  const Facts used = found();
  const fs::path out = scratch_.folder();
  EXPECT_EQ(context_.results, (std::vector<fs::path>{out / "run.h5", out / "stability.json"}));
  const talus::Run run = read_run(out / "run.h5");
  EXPECT_EQ(run.summary.steps, 0);
  EXPECT_EQ(run.summary.scene, "block");
  EXPECT_EQ(fact(used, "id"), fact(run.summary.provenance, run_id));
  // tan(30 deg) over the slope; the bracket is 10 % wide.
  EXPECT_NEAR(std::stod(fact(used, "stability.factor_of_safety")), std::tan(std::numbers::pi / 6) / 0.25, 0.1 * 2.31);
}

TEST_F(StabilityStage, writes_nothing_where_it_is_only_asked_for_a_check) {
  context_.check_only = true;
  EXPECT_TRUE(found().empty());
  EXPECT_TRUE(context_.results.empty());
  EXPECT_FALSE(fs::exists(scratch_.folder() / "run.h5"));
}

}  // namespace
}  // namespace talus::solver::testing
