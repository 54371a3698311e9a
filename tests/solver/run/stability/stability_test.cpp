// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Factor of safety against closed forms and a published slope, the mass that fails, and the files of a search.
#include "solver/run/stability/stability.hpp"

#include "common/stage/console.hpp"
#include "solver/options/stability.hpp"
#include "solver/options/walls.hpp"
#include "solver/run/stability/stability_products.hpp"
#include "solver/run/stability/stability_stage.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

double slope_tangent(double degrees) { return std::tan(degrees * std::numbers::pi / 180); }

/// A block that cannot fail in itself on a plane of this slope, 4 x 4 m and 2 m thick along the vertical.
struct BlockOnSlope {
  double slope = slope_tangent(20);
  Domain domain = ground(12, 12, 1.0, 1.0, [this](double x, double) { return 100 - slope * x; });
  SolveOptions options;
  BlockOnSlope() {
    fill(domain, {4, 8, 4, 8, 0, 2});
    options.material.model = MaterialModel::hencky;
    options.base.friction_angle = 30;
    options.stability.factor_of_safety = true;
    options.stability.tolerance = 0.01;
  }
};

/// tan(phi) (1 - r) / tan(beta) + c / (rho g z sin(beta) cos(beta)), of the infinite slope: exact for a block as well.
double infinite_slope(const BlockOnSlope& s, double pore_pressure_ratio, double cohesion) {
  const double c = 1 / std::sqrt(1 + s.slope * s.slope), sine = s.slope * c;
  return slope_tangent(30) * (1 - pore_pressure_ratio) / s.slope + cohesion / (2000 * 9.81 * 2 * sine * c);
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

TEST(Stability, level_ground_has_no_factor) {
  BlockOnSlope s;
  s.slope = 0;
  s.domain = ground(12, 12, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(s.domain, {4, 8, 4, 8, 0, 2});
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
  Domain domain = ground(40, 6, cell, cell, [](double, double) { return 0.0; });
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
    options.walls.push_back({Axis::x, west, Side::above, WallKind::roller});
    options.walls.push_back({Axis::y, south, Side::above, WallKind::roller});
    options.walls.push_back({Axis::y, south + cell, Side::below, WallKind::roller});
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
  const auto faults_of = [](const SolveOptions& options) {
    std::vector<Fault> faults;
    SolveOptions o = options;
    recipe::find_unmet(o, faults);
    return faults;
  };
  SolveOptions o;
  o.stability.factor_of_safety = true;
  EXPECT_TRUE(faults_of(o).empty());
  SolveOptions strong = o;
  strong.material.model = MaterialModel::hencky;
  strong.base.law = FrictionLaw::stick;
  SolveOptions softening = o;
  softening.material.softening_slip = 1;
  SolveOptions flowing = o;
  flowing.material.model = MaterialModel::mu_of_i;
  SolveOptions bent = o;
  bent.material.model = MaterialModel::corotated;
  SolveOptions snow = o;
  snow.base.law = FrictionLaw::voellmy;
  SolveOptions shaken = o;
  shaken.shaking.file = "record.csv";
  SolveOptions idle;
  idle.stability.tolerance = 0.01;
  for (const SolveOptions& refused : {strong, softening, flowing, bent, snow, shaken, idle}) {
    const auto faults = faults_of(refused);
    ASSERT_EQ(faults.size(), 1U);
    EXPECT_NE(faults[0].what.find("[solve.stability]"), std::string::npos);
  }
}

namespace fs = std::filesystem;

/// A block of 2 m on a plane that falls by a quarter, on a bed of 30 degrees.
class StabilityStage : public ::testing::Test {
 protected:
  StabilityStage()
      : domain_(ground(12, 12, 1.0, 1.0, [](double x, double) { return 100 - 0.25 * x; })),
        context_{recipe::Recipe(scratch_.write("recipe.toml", "[scene]\nname = \"block\"\n")), scratch_.folder(), false,
                 "test"} {
    fill(domain_, {4, 8, 4, 8, 0, 2});
    options_.material.model = MaterialModel::hencky;
    options_.base.friction_angle = 30;
    options_.stability.factor_of_safety = true;
    options_.stability.tolerance = 0.1;
  }

  Facts found() { return find_stability(context_, options_, make_device(On::cpu), domain_); }

  test::Scratch scratch_;
  Domain domain_;
  SolveOptions options_;
  StageContext context_;
};

TEST_F(StabilityStage, says_what_the_domain_was_warned_of_where_it_is_checked) {
  domain_.findings = {test::finding(Severity::warning, "coarse-grid", "the grid is coarse")};
  context_.check_only = true;
  EXPECT_EQ(test::findings_of([&] { found(); }), domain_.findings);
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
