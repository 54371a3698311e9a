// An implicit step as Newton's method sees it: its linear system is the derivative of its residual, on particles, bed
// and grid as they are in a run.
#include "solver/implicit/implicit_step.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "solver/boundary/contact_impulses.hpp"
#include "solver/boundary/surface_contact.hpp"
#include "solver/implicit/controls.hpp"
#include "solver/implicit/step_parts.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_solver.hpp"
#include "solver/scene/settings.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

using Shape = Quadratic;

SolveOptions options_of(Integrator integrator) {
  SolveOptions o;
  o.integrator = integrator;
  o.shape = ShapeKind::quadratic;
  o.material.model = MaterialModel::hencky;
  o.material.youngs_modulus = 1e6;
  o.implicit.step = 0.01;
  return o;
}

/// A block on a slope, all that a step of it works on, and the step.
struct StepBench {
  CpuDevice device = CpuDevice::make();
  Scene scene;
  SolverSettings settings;
  SolverState state;
  Materials<double> materials;
  Particles<double, CpuDevice> points;
  SparseGrid<double, CpuDevice> grid;
  SurfaceContact<double, CpuDevice, Shape> surfaces;
  ContactImpulses<double, CpuDevice, Shape> impulses;
  SumSpace<CpuDevice> sums{device};
  ImplicitStep<double, CpuDevice, Shape> step;

  static Scene make(const SolveOptions& o) {
    Domain d = ground(14, 12, 1.0, 1.0, [](double x, double) { return 10 - 0.6 * x; });
    fill(d, {4, 8, 4, 8, 0, 3});
    return make_scene(d, o);
  }
  static ParticleNeeds needs(const IntegratorSettings& s) {
    ParticleNeeds n = s.needs;
    n.accelerations = true;
    return n;
  }
  explicit StepBench(const SolveOptions& o)
      : scene(make(o)),
        settings(make_settings(o, scene.grid)),
        materials(settings.common.materials.in<double>()),
        points(device, needs(settings.common)),
        grid(device, scene.grid, 0),
        surfaces(device, scene.contacts, settings.common.bed, scene.grid, {}, false),
        impulses(device),
        step({.device = device,
              .settings = settings.common,
              .controls = settings.implicit,
              .points = points,
              .grid = grid,
              .materials = materials,
              .dilatant = false,
              .surfaces = surfaces,
              .impulses = impulses,
              .sums = sums,
              .cell = {.spacing = scene.grid.spacing,
                       .layer_height = scene.grid.layer_height,
                       .layer_mass = materials.list[0].density * scene.grid.layer_height,
                       .full_base = Shape::edge_share * materials.list[0].density}},
             {device, settings.common.bed, scene.bed}) {
    points.upload(scene.points);
    grid.fit(points, 0);
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
      const double along = bench.step.begin_search(), share = 1e-3;
      bench.step.apply_change(share);
      bench.step.measure(Linearisation::consistent);
      const Unbalanced after = bench.step.residual(Contacts::kept);
      EXPECT_NEAR(after.force / before, 1 - share, 0.02 * share) << name_of(o.shape) << (b_bar ? ", B-bar" : "");
      EXPECT_NEAR(after.along / along, 1 - share, 0.02 * share);
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
  EXPECT_LE(report.residual, o.implicit.newton_tolerance);
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
