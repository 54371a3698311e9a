// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The force (T12b) of a contact point: it pushes, sticks within Coulomb's cone, slips on it, and has the derivative
// that goes with that.
#include "solver/implicit/contact_forces.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::solver::testing {
namespace {

/// A contact point on level ground that pressed with 10 N in the last step.
struct OneContact {
  Vec3<double> normal{0, 0, 1}, before{0, 0, 10};
  double spring = 1000, coefficient = 0.5, limit = 5;
  Sym3<double> stiffness;

  Vec3<double> force(const Vec3<double>& u, Sym3<double>* k = nullptr) {
    ContactView<double> view{};
    view.normal = &normal;
    view.force = &before;
    const ContactNumbers numbers{
        .spring = &spring, .coefficient = &coefficient, .limit = &limit, .stiffness = &stiffness, .modulus = 0};
    return contact_force(view, numbers, 0, u, k);
  }
};

TEST(ContactForce, goes_on_from_the_last_step) {
  OneContact c;
  EXPECT_EQ(c.force({}).z, 10);
  EXPECT_EQ(c.force({}).x, 0);
}

TEST(ContactForce, sticks_within_the_limit) {
  OneContact c;
  const Vec3<double> f = c.force({0.004, 0, -0.002});
  EXPECT_DOUBLE_EQ(f.x, -4);
  EXPECT_DOUBLE_EQ(f.z, 12);
}

TEST(ContactForce, slips_at_the_limit) {
  OneContact c;
  const Vec3<double> f = c.force({0.3, 0.4, 0});
  EXPECT_NEAR(f.x, -3, 1e-12);
  EXPECT_NEAR(f.y, -4, 1e-12);
  EXPECT_NEAR(f.z, 10, 1e-12);
}

TEST(ContactForce, does_not_pull) {
  OneContact c;
  Sym3<double> k{1, 1, 1, 1, 1, 1};
  EXPECT_EQ(length(c.force({0, 0, 0.02}, &k)), 0);
  EXPECT_EQ(trace(k), 0);
}

TEST(ContactForce, has_the_derivative_that_it_says) {
  OneContact c;
  c.normal = {0.36, 0.48, 0.8};
  c.before = c.normal * 10;
  for (const Vec3<double>& u : {Vec3<double>{1e-3, 0, 0}, Vec3<double>{0.02, -0.01, 0}}) {
    Sym3<double> got;
    c.force(u, &got);
    const double h = 1e-7;
    const Vec3<double> axes[3] = {{h, 0, 0}, {0, h, 0}, {0, 0, h}};
    for (const Vec3<double>& d : axes) {
      const Vec3<double> expected = (c.force(u - d) - c.force(u + d)) * (0.5 / h);
      EXPECT_NEAR(length(got * d * (1 / h) - expected), 0, 1e-4 * c.spring);
    }
  }
}

}  // namespace
}  // namespace talus::solver::testing
