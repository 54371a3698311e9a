// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What hardly any slide does is refused unless the recipe insists; the energy line, and how the ground bends below it.
#include "solver/plan/checks.hpp"

#include "solver/plan/energy_line.hpp"
#include "tests/common/findings.hpp"
#include "tests/common/scratch.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A block on a slope of 27 degrees, some metres thick.
Domain plausible_block(double thickness) {
  Domain d = ground(40, 24, 2.0, 1.0, [](double x, double) { return 50 - 0.5 * x; });
  fill(d, {10, 22, 12, 36, 0, thickness});
  for (int row = 6; row < 18; ++row) {
    for (int column = 5; column < 11; ++column) d.release_thickness.at(column, row) = thickness;
  }
  return d;
}

/// The refusal of a scene; empty where none is.
std::string refusal_of(const Domain& domain, const SolveOptions& o, std::vector<std::string> accept = {}) {
  return test::fault_of<DataError>(
      [&] { test::findings_of([&] { refuse_implausible(*drafted(domain, o)); }, std::move(accept)); });
}

void expect_all_of(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) EXPECT_NE(text.find(word), std::string::npos) << word << " in: " << text;
}

TEST(Plausible, an_ordinary_slide_passes) {
  SolveOptions o;
  EXPECT_EQ(refusal_of(plausible_block(4), o), "");
  o.material.youngs_modulus = 1e6;
  EXPECT_EQ(refusal_of(plausible_block(4), o), "");
}

TEST(Plausible, a_mass_that_its_weight_squashes_is_refused_with_its_numbers) {
  SolveOptions o;
  o.material.youngs_modulus = 1e4;  // 4 m press with 78 kPa, and made a deposit of 7.4 m
  const std::string refusal = refusal_of(plausible_block(4), o);
  expect_all_of(refusal,
                {"4 m", "7.85e+04 Pa", "youngs_modulus_Pa = 1e+04", "accept = [\"weight-strain\"] in [solve]"});
  o.accept = {"weight-strain", "slow-waves"};
  const auto made = plan(plausible_block(4), o);
  const auto found = std::ranges::find(made->findings, "weight-strain", &Finding::name);
  ASSERT_NE(found, made->findings.end());
  EXPECT_EQ(found->severity, Severity::refusal);
  EXPECT_NE(found->message.find("7.85e+04 Pa"), std::string::npos);
  EXPECT_NEAR(found->numbers.at(1).value, 2000 * 9.81 * 4, 1);
}

TEST(Plausible, the_weight_is_that_of_the_columns_with_the_material) {
  SolveOptions o;
  o.parts.push_back({.release = "soft", .material = {}});
  o.parts[0].material.youngs_modulus = 1e4;
  o.parts[0].material.density = 1000;
  Domain d = plausible_block(4);
  d.release_names.push_back("soft");
  std::fill(d.points.release.begin(), d.points.release.begin() + 8, 1);
  const auto found = test::findings_of([&] { refuse_implausible(*drafted(d, o)); }, {"weight-strain", "slow-waves"});
  const auto number = [&](const char* name) {
    return std::ranges::find(found.at(0).numbers, name, &FindingNumber::name)->value;
  };
  EXPECT_EQ(number("youngs_modulus"), 1e4);
  EXPECT_LT(number("pressure"), 2000 * 9.81 * 4);
  EXPECT_GT(number("pressure"), 1000 * 9.81 * 4);
  EXPECT_NEAR(number("thickness"), 4, 1e-12);
}

TEST(Plausible, waves_beyond_those_of_any_solid_are_refused) {
  SolveOptions o;
  for (const double modulus : {1e15, 1e300}) {
    o.material.youngs_modulus = modulus;
    expect_all_of(refusal_of(plausible_block(4), o), {"youngs_modulus_Pa", "20 km/s", "fast-waves"});
  }
  o.material.youngs_modulus = 6e10;  // granite
  o.material.density = 2700;
  EXPECT_EQ(refusal_of(plausible_block(4), o), "");
}

TEST(Plausible, waves_far_slower_than_the_flow_are_refused) {
  SolveOptions o;
  o.material.youngs_modulus = 2e4;
  o.material.density = 1500;
  o.base.law = FrictionLaw::none;
  const std::string refusal = refusal_of(plausible_block(0.5), o);  // too thin to be squashed by its weight
  expect_all_of(refusal, {"waves run at", "slow-waves"});
}

TEST(Plausible, a_load_that_would_throw_the_mass_out_is_refused) {
  SolveOptions o;
  LoadOptions load;
  load.extent = {10, 12, 22, 36, 0, 4};
  load.force = {0, 0, 1e15};
  o.loads.push_back(load);
  expect_all_of(refusal_of(plausible_block(4), o), {"1e+15 N", "force_N", "strong-loads"});
  o.loads[0].force = {0, 0, 1e6};
  EXPECT_EQ(refusal_of(plausible_block(4), o), "");
}

TEST(Plausible, names_that_can_be_accepted_are_those_of_the_recipe) {
  SolveOptions o;
  o.material.youngs_modulus = 1e4;
  EXPECT_EQ(refusal_of(plausible_block(4), o, {std::begin(acceptable), std::end(acceptable)}), "");
}

/// Ground of this elevation in cells of 10 m, with 5 m released about (50, 50).
Domain with_release(const std::function<double(double, double)>& elevation) {
  Domain d = ground(30, 12, 10, 2, elevation);
  d.release_thickness.at(4, 4) = 5;
  return d;
}

SolveOptions bed_of(double degrees) {
  SolveOptions o;
  o.base.friction_angle = degrees;
  return o;
}

TEST(EnergyLine, falls_from_the_top_of_the_release_by_the_friction_of_the_bed) {
  const Domain d = with_release([](double x, double) { return 200 - 0.5 * x; });
  const EnergyLine line = energy_line_of(d, bed_of(20), {});
  const double mu = std::tan(20 * M_PI / 180), x = d.grid.x(4), top = 200 - 0.5 * x + 5;
  EXPECT_DOUBLE_EQ(line.z, top);
  EXPECT_NEAR(line.friction, mu, 1e-12);
  EXPECT_NEAR(line.head(d.terrain, 14, 4), 5 + 0.5 * 100 - mu * 100, 1e-9);
  EXPECT_LT(line.head(d.terrain, 0, 4), 0) << "the ground rises faster than nothing falls";
  EXPECT_NEAR(line.largest_head(d.terrain), 5 + (0.5 - mu) * (d.grid.x(29) - x), 1e-9);
}

TEST(EnergyLine, allows_nothing_where_nothing_is_released) {
  Domain d = ground(8, 8, 10, 2, [](double, double) { return 0.0; });
  const EnergyLine line = energy_line_of(d, bed_of(20), {});
  EXPECT_EQ(line.largest_head(d.terrain), 0);
  EXPECT_EQ(bend_over_thickness(d, line), 0);
}

TEST(EnergyLine, ground_bends_by_the_rise_of_an_arc_over_its_chord) {
  // Slopes of an even slope change by nothing; those of z = r y^2 / 2 by 10 r a cell along y, a rise of 10^2 r / 8, and
  // by nothing along x: half of that on the mean, over 5 m.
  const auto bend = [](double r, double slope) {
    const Domain d = with_release([=](double x, double y) { return 300 - slope * x + r * (y - 50) * (y - 50) / 2; });
    return bend_over_thickness(d, energy_line_of(d, bed_of(10), {}));
  };
  EXPECT_NEAR(bend(0, 0.6), 0, 1e-14);
  EXPECT_NEAR(bend(0.01, 0.6), 0.5 * 100 * 0.01 / 8 / 5, 1e-12);
}

TEST(EnergyLine, layers_are_thinner_across_themselves_on_steep_ground) {
  const Domain slope = with_release([](double x, double y) { return 300 - 0.6 * x + 0.2 * y; });
  EXPECT_NEAR(steepness(slope, energy_line_of(slope, bed_of(10), {})), 1 + 0.36 + 0.04, 1e-12);
  Domain empty = ground(8, 8, 10, 2, [](double x, double) { return 50 - x; });
  EXPECT_EQ(steepness(empty, energy_line_of(empty, bed_of(20), {})), 1) << "nothing is released";
}

TEST(EnergyLine, ground_above_it_and_voids_do_not_count) {
  // Bumps west of the release, which lies at the foot of the ground that rises there.
  Domain d =
      with_release([](double x, double) { return x < 40 ? 500 - 10 * x + 20 * std::cos(x) : 100 - 0.6 * (x - 40); });
  d.release_thickness.at(4, 4) = 0;
  d.release_thickness.at(8, 4) = 5;
  d.terrain.at(20, 5) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NEAR(bend_over_thickness(d, energy_line_of(d, bed_of(10), {})), 0, 1e-12);
}

}  // namespace
}  // namespace talus::solver::testing
