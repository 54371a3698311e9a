// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// stiffness = "auto": what it chooses and why, and that the flow stays the same.
#include <cmath>
#include <cstdio>
#include <numbers>

#include "solver/options/solve.hpp"
#include "solver/plan/stiffness.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
#include "tests/solver/plans.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A slope that eases from 35 degrees to a level over 400 m, with a slab of 80 x 40 m on its upper end, four layers
/// deep at 20 m.
Domain slope(double thickness) {
  constexpr double foot = 400;
  Domain d =
      ground(80, 12, 10, 5, [](double x, double) { return x < foot ? 0.35 * (foot - x) * (foot - x) / foot : 0.0; });
  for (int row = 4; row < 8; ++row) {
    for (int column = 6; column < 14; ++column) d.release_thickness.at(column, row) = thickness;
  }
  fill(d, {60, 140, 40, 80, 0, thickness});
  return d;
}

SolveOptions sliding(double modulus) {
  SolveOptions o;
  o.material.youngs_modulus = modulus;
  o.material.stiffness = StiffnessKind::automatic;
  o.material.cone = Cone::compression;
  o.base.friction_angle = 20;
  o.end_time = 20;
  return o;
}

TEST(Stiffness, follows_the_energy_line_of_the_scene) {
  const Domain d = slope(5);
  const SpeedBound bound = begun(d, sliding(1e9)).bound;
  const double speed = bound.speed;
  const StiffnessDemand demand = lowest_stiffness(sliding(1e9), bound);
  // Ground 0.35 (400 - x)^2 / 400 against an energy line that falls by tan 20: furthest apart where the ground is as
  // steep as the line.
  const auto height = [](double x) { return 0.35 * (400 - x) * (400 - x) / 400; };
  const double mu = std::tan(20 * std::numbers::pi / 180), x = 400 - mu * 400 / 0.7;
  const double head = height(65) + 5 - height(x) - mu * (x - 65);
  EXPECT_NEAR(speed, std::sqrt(2 * 9.81 * head), 0.01 * speed);
  const double confined = 0.75 / (1.25 * 0.5);
  EXPECT_NEAR(demand.modulus, 2000 * speed * speed / 0.02 / confined, 1e-6 * demand.modulus);
  EXPECT_NE(demand.reason.find("dynamic pressure"), std::string::npos) << demand.reason;
  SolveOptions finer = sliding(1e9);
  finer.material.stiffness_strain = 0.08;
  EXPECT_NEAR(lowest_stiffness(finer, begun(d, finer).bound).modulus, demand.modulus / 4, 1e-6 * demand.modulus);
}

TEST(Stiffness, carries_the_weight_of_a_deep_release) {
  Domain d = slope(20);
  for (double& t : d.release_thickness.values) t *= 15;
  const StiffnessDemand demand = lowest_stiffness(sliding(1e10), begun(d, sliding(1e10)).bound);
  EXPECT_LT(2000 * 9.81 * 300 / (1.2 * demand.modulus), 0.01);
}

TEST(Stiffness, is_never_more_than_the_recipe_gives) {
  const StiffnessDemand demand = lowest_stiffness(sliding(1e6), begun(slope(20), sliding(1e6)).bound);
  EXPECT_EQ(demand.modulus, 1e6);
  EXPECT_NE(demand.reason.find("no more than is needed"), std::string::npos) << demand.reason;
}

TEST(Stiffness, of_an_elastic_body_is_its_own) {
  SolveOptions o = sliding(1e9);
  std::vector<Fault> faults;
  recipe::find_unmet(o, faults);
  EXPECT_TRUE(faults.empty());
  o.material.model = MaterialModel::hencky;
  recipe::find_unmet(o, faults);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_NE(faults[0].what.find("stiffness = \"auto\""), std::string::npos) << faults[0].what;
  EXPECT_NE(faults[0].mend.find("drucker-prager"), std::string::npos) << faults[0].mend;
}

class StiffnessRuns : public InEachPlace {};
TEST_P(StiffnessRuns, leave_the_deposit_where_it_was) {
  const Domain d = slope(20);
  const auto deposit = [&](const SolveOptions& o) {
    const auto solver = make_solver(make_scene(d, o), o, GetParam());
    solver->set_next_event(o.end_time);
    while (solver->clock().time < o.end_time) EXPECT_NE(solver->advance().clock.alarms.halt, failed);
    return std::pair{solver->thickness(), solver->clock().step};
  };
  SolveOptions full = sliding(1e9);
  full.material.stiffness = StiffnessKind::as_given;
  const StiffnessDemand demand = lowest_stiffness(full, begun(d, full).bound);
  const auto [stiff, many] = deposit(full);
  const auto [soft, few] = deposit(with_stiffness(full, demand));
  double moved = 0, all = 0, way_stiff = 0, way_soft = 0;
  for (std::size_t n = 0; n < soft.size(); ++n) {
    const double from_start = d.grid.x(static_cast<int>(n) % d.grid.columns) - 100;
    moved += 0.5 * std::abs(soft[n] - stiff[n]);
    all += stiff[n];
    way_stiff += stiff[n] * from_start;
    way_soft += soft[n] * from_start;
  }
  std::printf(
      "  stiffness %.2g Pa instead of 1e9 Pa: %.2f %% of the deposit elsewhere, centre's way %+.2f %%, %lld steps "
      "instead of %lld\n",
      demand.modulus, 100 * moved / all, 100 * (way_soft / way_stiff - 1), static_cast<long long>(few),
      static_cast<long long>(many));
  EXPECT_NEAR(way_soft, way_stiff, 0.01 * way_stiff);
  EXPECT_LT(moved, 0.02 * all);
  EXPECT_LT(few * 3, many);
}
TALUS_IN_EACH_PLACE(StiffnessRuns);

}  // namespace
}  // namespace talus::solver::testing
