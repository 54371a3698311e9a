// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The force of the slide on the ground: against a block's closed form, and against what bed and walls were counted to
// give.
#include "solver/run/recorders/ground_force.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/common/findings.hpp"
#include "tests/solver/run/recorders/recorded.hpp"

namespace talus::solver::testing {
namespace {

constexpr double slope = 30 * std::numbers::pi / 180, bed_friction = 15 * std::numbers::pi / 180, g = 9.81;
constexpr double mass = 8 * 8 * 2 * 2000;

Domain sliding_block(int columns) {
  Domain d = ground(columns, 24, 1.0, 1.0, [](double x, double) { return 100 - std::tan(slope) * x; });
  fill(d, {10, 18, 8, 16, 0, 2});
  return d;
}

SolveOptions stiff_block() {
  SolveOptions o;
  o.integrator = Integrator::explicit_;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e8;
  o.base.law = FrictionLaw::coulomb;
  o.base.friction_angle = 15;
  return o;
}

class GroundForce : public InEachPlace {};

/// A block with friction goes down with a = g (sin s - tan f cos s) and pushes the ground back with -m a: towards the
/// west where it slides to the east, and up, by as much as it weighs less than at rest. Two per cent: the block gives a
/// little as it lets go, and its momentum swings by that over half a second.
TEST_P(GroundForce, of_a_block_on_an_incline_is_its_mass_times_its_acceleration) {
  const RunHistory h = recorded(sliding_block(64), stiff_block(), GetParam(), 3, 0.5);
  const double a = g * (std::sin(slope) - std::tan(bed_friction) * std::cos(slope));
  const auto values = [&](const char* name) { return h.at(name).values; };
  EXPECT_EQ(values("ground_force_x_N")[0], 0);
  double impulse = 0;
  for (std::size_t row = 1; row < h.columns[0].values.size(); ++row) {
    EXPECT_NEAR(values("ground_force_x_N")[row], -mass * a * std::cos(slope), 0.02 * mass * a) << row;
    EXPECT_NEAR(values("ground_force_y_N")[row], 0, 1e-3 * mass * a) << row;
    EXPECT_NEAR(values("ground_force_z_N")[row], mass * a * std::sin(slope), 0.02 * mass * a) << row;
    impulse += 0.5 * values("ground_force_x_N")[row];
  }
  EXPECT_NEAR(impulse, -values("momentum_x_kg_m_s").back(), 1e-9 * mass * g);
}

/// The kernels count the impulse of bed and walls on the mass where a budget is kept. It holds the weight up and bends
/// the mass off its way, so that what the ground gets beyond the weight is -(reaction + weight * time).
TEST_P(GroundForce, is_what_bed_and_walls_were_counted_to_give) {
  SolveOptions o = stiff_block();
  o.material.model = MaterialModel::drucker_prager;
  o.material.youngs_modulus = 1e7;
  o.energy_budget = true;
  const RunHistory h = recorded(sliding_block(64), o, GetParam(), 2, 0.25);
  const auto values = [&](const char* name) { return h.at(name).values; };
  for (std::size_t row = 1; row < h.columns[0].values.size(); ++row) {
    const auto counted = [&](const char* name, double weight) {
      return -(values(name)[row] - values(name)[row - 1]) / 0.25 - weight;
    };
    EXPECT_NEAR(values("ground_force_x_N")[row], counted("reaction_x_N_s", 0), 1e-6 * mass * g) << row;
    EXPECT_NEAR(values("ground_force_y_N")[row], counted("reaction_y_N_s", 0), 1e-6 * mass * g) << row;
    EXPECT_NEAR(values("ground_force_z_N")[row], counted("reaction_z_N_s", -mass * g), 1e-6 * mass * g) << row;
  }
}

TEST_P(GroundForce, is_not_known_where_matter_leaves) {
  std::vector<std::string> warnings;
  const RunHistory h = recorded(
      sliding_block(32), stiff_block(), GetParam(), 4, 0.5,
      [&](const Solver&, const Scene&, const History& now) { warnings = test::messages_of([&] { now.conclude(); }); });
  std::size_t unknown = 0;
  const auto &force = h.at("ground_force_x_N").values, &outflow = h.at("outflow_m3").values;
  for (std::size_t row = 1; row < force.size(); ++row) {
    EXPECT_EQ(std::isnan(force[row]), outflow[row] != outflow[row - 1]) << row;
    unknown += std::isnan(force[row]) ? 1U : 0U;
  }
  EXPECT_GE(unknown, 1U);
  ASSERT_FALSE(warnings.empty());
  EXPECT_EQ(warnings[0].find("the force on the ground is not known in " + std::to_string(unknown)), 0U) << warnings[0];
}

TALUS_IN_EACH_PLACE(GroundForce);

TEST(GroundForceColumns, are_left_out_where_momentum_does_not_say_it) {
  SolveOptions o = stiff_block();
  EXPECT_TRUE(GroundForceRecorder::measures(o));
  o.loads.resize(1);
  EXPECT_FALSE(GroundForceRecorder::measures(o));
}

}  // namespace
}  // namespace talus::solver::testing
