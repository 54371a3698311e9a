// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed: impulses of a base node.
#include "solver/boundary/base_friction.hpp"

#include <gtest/gtest.h>

namespace talus {
namespace {

BaseFriction<double> coulomb(double mu) { return {FrictionLaw::coulomb, {{mu}}}; }
Vec3<double> meet(const BaseFriction<double>& f, const Vec3<double>& v, double sx, double sy, double grip = 0) {
  return meet_ground(f, 0, v, sx, sy, {.duration = 0.01, .grip = grip});
}

TEST(MeetGround, lets_a_leaving_node_go) {
  const Vec3<double> v = meet(coulomb(0.5), Vec3<double>{1, 0, 0.6}, 0.5, 0.0);
  EXPECT_EQ(v.x, 1);
  EXPECT_EQ(v.z, 0.6);
}

TEST(MeetGround, takes_the_normal_velocity_and_mu_times_it_along_the_slip) {
  const Vec3<double> v = meet(coulomb(0.5), Vec3<double>{3, 0, -2}, 0.0, 0.0);
  EXPECT_DOUBLE_EQ(v.z, 0);
  EXPECT_DOUBLE_EQ(v.x, 3 - 0.5 * 2);
}

TEST(MeetGround, sticks_when_friction_suffices) {
  const Vec3<double> v = meet(coulomb(0.5), Vec3<double>{0.9, 0, -2}, 0.0, 0.0);
  EXPECT_EQ(v.x, 0);
  EXPECT_EQ(v.z, 0);
}

TEST(MeetGround, leaves_a_sloping_bed_tangentially) {
  const double sx = 0.4, sy = -0.3;
  const Vec3<double> v = meet(coulomb(0.1), Vec3<double>{2, 1, -3}, sx, sy);
  EXPECT_NEAR(v.z, sx * v.x + sy * v.y, 1e-14);
}

TEST(MeetGround, leaves_cohesion_and_drag_to_the_column) {
  const BaseFriction<double> f{FrictionLaw::voellmy, {{0.5, 3}, 10}};  // 3 Pa s2/m2, 10 Pa
  EXPECT_DOUBLE_EQ(meet(f, Vec3<double>{4, 0, -2}, 0.0, 0.0).x, 4 - 0.5 * 2);
  EXPECT_DOUBLE_EQ(f.drag(f.uniform, {4, 0, 0.01}), 3 * 16);
  EXPECT_TRUE(f.has_drag());
  EXPECT_TRUE(f.has_traction());
}

TEST(BaseFriction, weakens_from_peak_to_steady_state) {
  const BaseFriction<double> f{FrictionLaw::velocity_weakening, {{0.2, 0.7, 4}}};
  EXPECT_DOUBLE_EQ(f.coefficient(f.uniform, {0, 0, 0.01}), 0.7);
  EXPECT_DOUBLE_EQ(f.coefficient(f.uniform, {4, 0, 0.01}), 0.45);  // half the drop at the characteristic speed
  EXPECT_NEAR(f.coefficient(f.uniform, {1e9, 0, 0.01}), 0.2, 1e-8);
}

}  // namespace
}  // namespace talus
