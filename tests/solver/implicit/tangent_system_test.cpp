// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The linear system of a step: every solver of it has the same solution.
#include "solver/implicit/tangent_system.hpp"

#include "solver/implicit/scatter_inertia.hpp"
#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

/// The solution of the system of a body on its bed for a push that is the same for every solver [m].
std::vector<Vec3<double>> solution(LinearSolver solver) {
  SolveOptions o = options_of(Integrator::newmark);
  o.base.law = FrictionLaw::stick;
  o.implicit.linear_solver = solver;
  PartsBench bench(o);
  const auto parts = bench.parts();
  NodeFields<CpuDevice> nodes(bench.device);
  nodes.resize(bench.grid.nodes());
  const auto count = static_cast<std::size_t>(nodes.count);
  double pull = 0;
  ContactSet<double, CpuDevice, PartsBench::Shape> contacts(
      parts, nodes, {bench.device, bench.settings.common.bed, bench.scene.bed}, &pull);
  TangentSystem<double, CpuDevice, PartsBench::Shape> system(parts, nodes, contacts);
  const NewmarkScheme scheme{.dynamic = true, .step = 0.01};
  system.group();
  contacts.resize();
  system.begin(scheme);
  scatter_points(
      bench.device, bench.points.count(), bench.grid.groups(),
      ScatterInertia<double, PartsBench::Shape>{
          {bench.grid.view(), bench.points.view()}, bench.materials, false, true, nullptr, nodes.arrays(true)});
  contacts.begin(scheme, {}, {0, 0, -10});
  nodes.u.fill_zero();
  system.measure(Linearisation::consistent);
  const auto freed = nodes.freed.download();
  std::vector<Vec3<double>> push(count);
  for (std::size_t n = 0; n < count; ++n)
    push[n] =
        freed[n] * Vec3<double>{std::sin(1.0 * static_cast<double>(n)), 1, std::cos(2.0 * static_cast<double>(n))};
  NodeVector<CpuDevice> b(bench.device), x(bench.device);
  b.upload(push);
  x.upload(std::vector<Vec3<double>>(count));
  EXPECT_TRUE(system.solve(b, x, 1e-10).converged);
  return x.download();
}

TEST(TangentSystem, has_one_solution_by_any_solver) {
  const auto expected = solution(LinearSolver::cholesky);
  double size = 0;
  for (const Vec3<double>& v : expected) size += dot(v, v);
  EXPECT_GT(size, 0);
  const auto x = solution(LinearSolver::pcg);
  double off = 0;
  for (std::size_t n = 0; n < x.size(); ++n) off += dot(x[n] - expected[n], x[n] - expected[n]);
  // Conjugate gradients take tangents that are rounded to single precision, 6e-8 of them.
  EXPECT_LT(std::sqrt(off / size), 1e-5);
}

}  // namespace
}  // namespace talus::solver::testing
