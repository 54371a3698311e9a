// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The line search alone: which share of a change is taken, and what is left where none is.
#include "solver/implicit/line_search.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/implicit/toy_problem.hpp"

namespace talus::solver::testing {
namespace {

/// Brings the problem to where a search begins: the residual at u, and a change.
double begin(ToyProblem& p, double change) {
  p.measure(Linearisation::consistent);
  const double before = p.residual(Contacts::decided).force;
  p.change = Vector::Constant(1, change);
  return before;
}

ToyProblem spring(double start) {
  return scalar_problem(
      start, [](double u) { return 1 - u; }, [](double) { return 1.0; });
}

TEST(LineSearch, takes_the_whole_change_where_that_helps) {
  ToyProblem p = spring(0);
  const double before = begin(p, 1);
  const int measured = p.measures;
  EXPECT_TRUE(line_search(p, before, 1));
  EXPECT_EQ(p.u(0), 1);
  EXPECT_EQ(p.measures, measured + 1);
}

TEST(LineSearch, halves_a_change_that_goes_too_far) {
  ToyProblem p = spring(0);
  const double before = begin(p, 5);  // 5 and 2.5 leave more, 1.25 a quarter
  EXPECT_TRUE(line_search(p, before, 1));
  EXPECT_EQ(p.u(0), 1.25);
}

TEST(LineSearch, goes_back_where_no_share_helps) {
  ToyProblem p = spring(0.25);
  const double before = begin(p, -1);
  EXPECT_FALSE(line_search(p, before, 1));
  EXPECT_EQ(p.u(0), 0.25);
}

TEST(LineSearch, goes_back_where_it_is_told_to_give_up) {
  ToyProblem p = spring(0);
  const double before = begin(p, 5);  // the third share would do
  int asked = 0;
  EXPECT_FALSE(line_search(p, before, 1, [&] { return ++asked > 2; }));
  EXPECT_EQ(p.u(0), 0);
}

TEST(LineSearch, takes_a_larger_force_where_it_leads_downhill) {
  // Along the change the force vanishes, across it there is more than before.
  ToyProblem p;
  p.u = Vector::Zero(2);
  p.force = [](const Vector& u) -> Vector { return Vector((Vector(2) << 1 - u(0), 2 * u(0)).finished()); };
  p.tangent = p.definite = [](const Vector&) -> Matrix { return Matrix::Identity(2, 2); };
  p.measure(Linearisation::consistent);
  const double before = p.residual(Contacts::decided).force;
  p.change = (Vector(2) << 1, 0).finished();
  EXPECT_TRUE(line_search(p, before, 1));
  EXPECT_EQ(p.u(0), 1);
  p.measure(Linearisation::consistent);
  EXPECT_GT(p.residual(Contacts::kept).force, before);
}

TEST(LineSearch, takes_a_change_that_is_rounding) {
  ToyProblem p = spring(1 + 1e-13);
  const double before = begin(p, 2e-13);
  EXPECT_TRUE(line_search(p, before, 1));
  EXPECT_EQ(p.u(0), 1 + 1e-13 + 2e-13);
}

TEST(LineSearch, takes_another_active_set) {
  ToyProblem p = spring(0.1);
  p.force = [](const Vector& u) -> Vector { return Vector::Constant(1, -0.5 - u(0)); };
  p.friction = {{.limit = 0.2, .sticks = false, .direction = 1}};
  const double before = begin(p, -0.8);
  EXPECT_TRUE(line_search(p, before, 1));
  EXPECT_TRUE(p.friction[0].sticks);
  EXPECT_EQ(p.u(0), 0) << "a slip that is turned back ends where it turns";
}

TEST(LineSearch, refuses_forces_that_are_no_numbers) {
  ToyProblem p = scalar_problem(
      1, [](double u) { return std::sqrt(u) - 2; }, [](double) { return 1.0; });
  const double before = begin(p, -1.5);  // past zero, where the root is no number, and back
  EXPECT_FALSE(line_search(p, before, 1));
  EXPECT_EQ(p.u(0), 1);
}

}  // namespace
}  // namespace talus::solver::testing
