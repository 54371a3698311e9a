// A step of the implicit solver: its clock and what it reports.
#include "solver/implicit/implicit_solver.hpp"

#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

TEST(ImplicitSolver, makes_steps_of_the_recipe_up_to_the_next_event) {
  SolveOptions o = options_of(Integrator::newmark);
  o.implicit.step = 0.01;
  const Scene scene = PartsBench::make(o);
  const SolverSettings settings = make_settings(o, scene.grid);
  ImplicitSolver<double, CpuDevice, PartsBench::Shape> solver(CpuDevice::make(), scene, settings.common,
                                                              settings.implicit, first_state(scene, settings.common));
  EXPECT_EQ(solver.clock().accelerated, 0);
  solver.set_next_event(0.015);
  const BatchReport first = solver.advance();
  EXPECT_EQ(first.stats.cuts, 0);
  EXPECT_GE(first.stats.newton, 1);
  const Clock clock = solver.clock();
  EXPECT_EQ(clock.step, 1);
  EXPECT_EQ(clock.accelerated, 1) << "the points know their acceleration";
  EXPECT_GT(clock.time, 0);
  EXPECT_LE(clock.time, 0.01);
  run_to(solver, 0.015);
  EXPECT_EQ(solver.clock().time, 0.015);
}

}  // namespace
}  // namespace talus::solver::testing
