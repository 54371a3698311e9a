// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// An implicit step as Newton's method sees it: its linear system is the derivative of its residual, on particles, bed
// and grid as they are in a run.
#include "solver/implicit/implicit_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/options/solve.hpp"
#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

/// The step of a block on a slope.
struct StepBench : PartsBench {
  ImplicitStep<double, CpuDevice, Shape> step;

  explicit StepBench(const SolveOptions& o) : PartsBench(o), step(parts(), {device, settings.common.bed, scene.bed}) {
    step.group({});
    step.begin({.start = 0, .step = settings.implicit.step});
  }

  /// Contacts decided on until none changes.
  Unbalanced settle() {
    step.measure(Linearisation::consistent);
    Unbalanced now = step.residual(Contacts::decided);
    for (int i = 0; now.changed && i < 10; ++i) {
      step.measure(Linearisation::consistent);
      now = step.residual(Contacts::decided);
    }
    EXPECT_FALSE(now.changed);
    return now;
  }
};

TEST(ImplicitStep, has_a_linear_system_that_is_the_derivative_of_its_residual) {
  for (const auto integrator : {Integrator::newmark, Integrator::quasi_static}) {
    for (const bool b_bar : {false, true}) {
      SolveOptions o = options_of(integrator);
      o.implicit.b_bar = b_bar;
      // A sheet that slides without inertia goes far beyond the slip over which its friction turns.
      if (integrator == Integrator::quasi_static) o.base.law = FrictionLaw::stick;
      StepBench bench(o);
      const double before = bench.settle().force;
      ASSERT_GT(before, 1);
      ASSERT_TRUE(bench.step.solve(1e-12).converged);
      // With a small share of the change, that share of the residual is gone.
      constexpr double share = 1e-3;
      bench.step.begin_search();
      bench.step.apply_change(share);
      bench.step.measure(Linearisation::consistent);
      const Unbalanced after = bench.step.residual(Contacts::kept);
      EXPECT_NEAR(after.force / before, 1 - share, 0.02 * share) << name_of(o.shape) << (b_bar ? ", B-bar" : "");
      EXPECT_NEAR(after.along / after.downhill, 1 - share, 0.02 * share);
      bench.step.return_to_start();
      bench.step.measure(Linearisation::consistent);
      EXPECT_DOUBLE_EQ(bench.step.residual(Contacts::kept).force, before);
    }
  }
}

TEST(ImplicitStep, is_solved_by_newtons_method) {
  SolveOptions o = options_of(Integrator::newmark);
  StepBench bench(o);
  const NewtonReport report = bench.step.solve();
  EXPECT_TRUE(report.converged);
  EXPECT_LE(report.residual, scheme_of(o).tolerance);
  EXPECT_LT(bench.step.farthest_motion().share, 1);
  EXPECT_GT(bench.step.farthest_motion().length, 0);
}

TEST(ImplicitStep, counts_its_memory_by_name) {
  StepBench bench(options_of(Integrator::newmark));
  std::size_t total = 0;
  bool nodes = false;
  bench.step.list_memory([&](const std::string& name, std::size_t bytes) {
    total += bytes;
    nodes = nodes || (name == "nodes" && bytes > 0);
  });
  EXPECT_TRUE(nodes);
  EXPECT_GT(total, static_cast<std::size_t>(bench.points.count()) * sizeof(double));
}

}  // namespace
}  // namespace talus::solver::testing
