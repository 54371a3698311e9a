// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method and its line search on toy problems, and how exactly linear systems are asked for.
#include <gtest/gtest.h>

#include "solver/implicit/newton.hpp"
#include "tests/solver/implicit/toy_problem.hpp"

namespace talus::solver::testing {
namespace {

ImplicitControls controls(double tolerance = 1e-12, Forcing forcing = Forcing::fixed, double linear_tolerance = 1e-12) {
  ImplicitControls c;
  c.tolerance = tolerance;
  c.forcing = forcing;
  c.linear_tolerance = linear_tolerance;
  return c;
}

NewtonReport solved(ToyProblem& p) {
  const NewtonReport report = newton(p, controls());
  EXPECT_TRUE(report.converged);
  return report;
}

/// u^3 + u = 3.
ToyProblem cubic(double start = 0) {
  return scalar_problem(
      start, [](double u) { return 3 - u - u * u * u; }, [](double u) { return 1 + 3 * u * u; });
}

TEST(Newton, converges_quadratically_on_a_smooth_problem) {
  ToyProblem p = cubic();
  const NewtonReport report = solved(p);
  EXPECT_FALSE(report.indefinite);
  EXPECT_NEAR(p.u(0), 1.2134116627622296, 1e-12);  // of u^3 + u = 3
  EXPECT_EQ(report.linear_iterations, report.iterations);
  EXPECT_EQ(p.residuals.size(), static_cast<std::size_t>(report.iterations) + 1);
  // Once near the root the residual is squared, up to f'' / (2 f'^2) = 0.13.
  int squared = 0;
  for (std::size_t i = 1; i < p.residuals.size(); ++i) {
    if (p.residuals[i - 1] > 0.1 || p.residuals[i] < 1e-14) continue;
    EXPECT_LT(p.residuals[i], 0.2 * p.residuals[i - 1] * p.residuals[i - 1]) << "iteration " << i;
    ++squared;
  }
  EXPECT_GE(squared, 1);
}

TEST(Newton, solves_a_linear_problem_in_one_iteration) {
  ToyProblem p;
  p.u = Vector::Zero(2);
  const Eigen::Matrix2d k = (Eigen::Matrix2d() << 4, -1, -1, 3).finished();
  p.force = [k](const Vector& u) -> Vector { return Vector((Vector(2) << 1, 2).finished() - k * u); };
  p.tangent = p.definite = [k](const Vector&) -> Matrix { return k; };
  const NewtonReport report = solved(p);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_NEAR(p.u(0), 5.0 / 11, 1e-14);
  EXPECT_NEAR(p.u(1), 9.0 / 11, 1e-14);
}

TEST(Newton, finds_its_way_over_a_kink) {
  // A stop: a hundred times as stiff beyond u = 0. The first change overshoots it by far.
  ToyProblem p = scalar_problem(
      -1, [](double u) { return 10 - (u < 0 ? u : 100 * u); }, [](double u) { return u < 0 ? 1.0 : 100.0; });
  const NewtonReport report = solved(p);
  EXPECT_NEAR(p.u(0), 0.1, 1e-12);
  EXPECT_LE(report.iterations, 5);
  EXPECT_GT(p.measures, report.iterations + 1) << "no share of a change was ever refused";
}

TEST(Newton, goes_on_with_a_definite_tangent_where_its_own_is_singular) {
  // Two wells and a hill between them: where its slope is steepest the tangent is singular, above that negative.
  const double steepest = std::sqrt(1.0 / 3);
  ToyProblem p = scalar_problem(
      0, [](double u) { return u - u * u * u; }, [](double u) { return 3 * u * u - 1; });
  p.definite = [](const Vector& u) -> Matrix { return Matrix::Constant(1, 1, 3 * u(0) * u(0)); };
  for (const double start : {steepest - 1e-9, 1e-9 - steepest, steepest - 0.01}) {
    p.u(0) = start;
    const NewtonReport report = newton(p, controls());
    EXPECT_TRUE(report.converged) << "from " << start;
    EXPECT_TRUE(report.indefinite) << "from " << start;
    EXPECT_GT(report.linear_iterations, report.iterations);
    EXPECT_NEAR(p.u(0), start > 0 ? 1 : -1, 1e-12);
  }
  // Near the top every way down leads through larger forces: the step is refused there, and u is where it was.
  p.u(0) = 0.1;
  const NewtonReport report = newton(p, controls());
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(report.indefinite);
  EXPECT_EQ(p.u(0), 0.1);
}

TEST(Newton, refuses_what_nothing_holds) {
  ToyProblem p = scalar_problem(
      0, [](double) { return 1.0; }, [](double) { return 0.0; });
  const NewtonReport report = newton(p, controls());
  EXPECT_FALSE(report.converged);
  EXPECT_TRUE(report.indefinite);
  EXPECT_EQ(p.u(0), 0);
}

TEST(Newton, refuses_a_problem_without_a_solution) {
  ToyProblem p = scalar_problem(
      1, [](double u) { return 1 + u * u; }, [](double u) { return -2 * u; });
  p.definite = [](const Vector& u) -> Matrix { return Matrix::Constant(1, 1, 2 * std::abs(u(0)) + 1e-3); };
  const NewtonReport report = newton(p, controls());
  EXPECT_FALSE(report.converged);
  EXPECT_GE(report.residual, 1);
}

TEST(Newton, refuses_a_force_that_is_no_number) {
  ToyProblem p = scalar_problem(
      0, [](double) { return std::numeric_limits<double>::quiet_NaN(); }, [](double) { return 1.0; });
  const NewtonReport report = newton(p, controls());
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(p.searches, 0);
}

TEST(Newton, refuses_a_step_that_moves_too_far) {
  ToyProblem p = scalar_problem(
      0, [](double u) { return 2 - u; }, [](double) { return 1.0; });
  p.reach = 1;
  EXPECT_FALSE(newton(p, controls()).converged);
  p.u(0) = 0;
  p.reach = 3;
  EXPECT_TRUE(newton(p, controls()).converged);
}

TEST(Newton, ends_when_iterations_run_out) {
  ToyProblem p = cubic();
  ImplicitControls few = controls();
  few.newton_iterations = 2;
  const NewtonReport report = newton(p, few);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
}

TEST(Newton, gives_up_a_body_that_moves_on_without_an_equilibrium) {
  // Pulled by 1.1, held by 1 at most; the tangent is that of the start, so each change lets it go a little further.
  const auto pulled = [](double by) {
    return scalar_problem(
        0, [by](double u) { return by - u / (1 + u); }, [](double) { return 1.0; });
  };
  ToyProblem falls = pulled(1.1), rests = pulled(0.6);
  ImplicitControls patient = controls(1e-4);
  patient.newton_iterations = 80;
  const NewtonReport all = newton(falls, patient);
  EXPECT_FALSE(all.converged);
  EXPECT_EQ(all.iterations, 80);
  falls.u(0) = 0;
  patient.patience = 8;
  const NewtonReport few = newton(falls, patient);
  EXPECT_FALSE(few.converged);
  EXPECT_LT(few.iterations, 40);
  const NewtonReport slow = newton(rests, patient);
  EXPECT_TRUE(slow.converged);
  EXPECT_GT(slow.iterations, 2 * patient.patience) << "it must need more iterations than the test waits for";
}

/// Two blocks on a rough bed, each on a spring of its own and with one between them; the first is pulled.
ToyProblem two_blocks(double pull, double first_limit, double second_limit) {
  ToyProblem p;
  p.u = Vector::Zero(2);
  const Eigen::Matrix2d k =
      (Eigen::Matrix2d() << 3, -1, -1, 2).finished();  // springs of 2 and 1, and 1 between the blocks
  p.force = [k, pull](const Vector& u) -> Vector { return Vector((Vector(2) << pull, 0).finished() - k * u); };
  p.tangent = p.definite = [k](const Vector&) -> Matrix { return k; };
  p.friction = {{.limit = first_limit}, {.limit = second_limit}};
  return p;
}

TEST(Newton, leaves_what_friction_can_hold_where_it_is) {
  ToyProblem p = two_blocks(0.9, 1, 1);
  const NewtonReport report = solved(p);
  EXPECT_EQ(report.iterations, 0);
  EXPECT_EQ(p.u.norm(), 0) << "what rests must not slip at all";
}

TEST(Newton, lets_one_block_slip_and_the_other_stick) {
  ToyProblem p = two_blocks(3, 1, 1);
  solved(p);
  EXPECT_FALSE(p.friction[0].sticks);
  EXPECT_TRUE(p.friction[1].sticks);
  EXPECT_NEAR(p.u(0), (3.0 - 1) / 3, 1e-12);
  EXPECT_EQ(p.u(1), 0);
}

TEST(Newton, lets_the_second_block_slip_once_the_first_pulls_it) {
  ToyProblem p = two_blocks(9, 1, 1);
  const NewtonReport report = solved(p);
  EXPECT_FALSE(p.friction[1].sticks);
  // 3 u - v = 8, -u + 2 v = -1
  EXPECT_NEAR(p.u(0), 3, 1e-12);
  EXPECT_NEAR(p.u(1), 1, 1e-12);
  EXPECT_LE(report.iterations, 3);
}

TEST(Newton, lets_a_block_stick_again_that_turns_back) {
  // The second block begins as one that slips forwards; held by its own spring alone it would be pushed back.
  ToyProblem p = two_blocks(0.5, 1, 1);
  p.friction[1] = {.limit = 1, .sticks = false, .direction = 1};
  solved(p);
  EXPECT_TRUE(p.friction[1].sticks);
  EXPECT_EQ(p.reversals, 1);
  EXPECT_EQ(p.u.norm(), 0);
}

TEST(Newton, smooths_friction_less_before_it_accepts_what_may_rest) {
  ToyProblem p = scalar_problem(
      0, [](double u) { return 1e-6 - u; }, [](double) { return 1.0; });
  p.smooth = {.smooths = true, .gravity_way = 1, .width = FrictionSmoothing::widest};
  solved(p);
  EXPECT_EQ(p.smooth.width, FrictionSmoothing::narrowest);  // nothing has moved as far as any slip
}

TEST(Newton, smooths_friction_more_where_it_makes_no_progress) {
  // A force that changes its sign without passing through zero: no displacement balances it.
  ToyProblem p = scalar_problem(
      1, [](double u) { return u > 0 ? -1.0 - u : 1.0 - u; }, [](double) { return 1.0; });
  p.smooth = {.smooths = true, .gravity_way = 1, .width = FrictionSmoothing::narrowest};
  EXPECT_FALSE(newton(p, controls()).converged);
  EXPECT_EQ(p.smooth.width, FrictionSmoothing::widest);
}

TEST(Newton, solves_once_with_the_tangent_at_the_start) {
  ToyProblem p = cubic();
  const NewtonReport report = solve_once(p, controls());
  EXPECT_TRUE(report.converged);
  EXPECT_EQ(report.iterations, 1);
  EXPECT_EQ(p.u(0), 3);
  EXPECT_EQ(p.searches, 0);
  p.u(0) = 0;
  p.reach = 1;
  EXPECT_FALSE(solve_once(p, controls()).converged);
}

TEST(Newton, gives_up_between_iterations_where_it_is_told_to) {
  // Near enough that each change is taken whole.
  ToyProblem p = cubic(1);
  static int asked;  // what is asked holds no state of its own
  asked = 0;
  ImplicitControls c = controls();
  c.give_up = [] { return ++asked > 4; };  // before each iteration, and before each share of a change
  const NewtonReport report = newton(p, c);
  EXPECT_FALSE(report.converged);
  EXPECT_EQ(report.iterations, 2);
}

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
  EXPECT_TRUE(line_search(p, begin(p, 5), 1));  // 5 and 2.5 leave more, 1.25 a quarter
  EXPECT_EQ(p.u(0), 1.25);
}

TEST(LineSearch, goes_back_where_no_share_helps) {
  ToyProblem p = spring(0.25);
  EXPECT_FALSE(line_search(p, begin(p, -1), 1));
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
  EXPECT_TRUE(line_search(p, begin(p, 2e-13), 1));
  EXPECT_EQ(p.u(0), 1 + 1e-13 + 2e-13);
}

TEST(LineSearch, takes_another_active_set) {
  ToyProblem p = spring(0.1);
  p.force = [](const Vector& u) -> Vector { return Vector::Constant(1, -0.5 - u(0)); };
  p.friction = {{.limit = 0.2, .sticks = false, .direction = 1}};
  EXPECT_TRUE(line_search(p, begin(p, -0.8), 1));
  EXPECT_TRUE(p.friction[0].sticks);
  EXPECT_EQ(p.u(0), 0) << "a slip that is turned back ends where it turns";
}

TEST(LineSearch, refuses_forces_that_are_no_numbers) {
  ToyProblem p = scalar_problem(
      1, [](double u) { return std::sqrt(u) - 2; }, [](double) { return 1.0; });
  EXPECT_FALSE(line_search(p, begin(p, -1.5), 1));  // past zero, where the root is no number, and back
  EXPECT_EQ(p.u(0), 1);
}

TEST(LinearForcing, asks_for_as_much_as_the_last_iteration_brought) {
  const ImplicitControls c = controls(1e-6, Forcing::eisenstat_walker, 1e-8);
  LinearForcing forcing;
  EXPECT_EQ(forcing.next(1, c), 1e-3);
  EXPECT_DOUBLE_EQ(forcing.next(0.1, c), 0.9 * 0.01);
  EXPECT_DOUBLE_EQ(forcing.next(0.1, c), 0.1) << "no progress: at most this";
  EXPECT_DOUBLE_EQ(forcing.next(1e-5, c), 0.01) << "no finer than Newton's own tolerance asks for";
}

TEST(LinearForcing, keeps_to_one_tolerance_where_that_is_asked_for) {
  const ImplicitControls c = controls(1e-6, Forcing::fixed, 1e-8);
  LinearForcing forcing;
  for (const double residual : {1.0, 0.5, 1e-5}) EXPECT_EQ(forcing.next(residual, c), 1e-8);
}

TEST(LinearForcing, asks_for_no_more_than_the_finest_tolerance) {
  const ImplicitControls c = controls(1e-12, Forcing::eisenstat_walker, 1e-8);
  LinearForcing forcing;
  forcing.next(1, c);
  EXPECT_EQ(forcing.next(1e-5, c), 1e-8);
}

}  // namespace
}  // namespace talus::solver::testing
