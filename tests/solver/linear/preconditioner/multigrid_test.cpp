// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauss-Seidel and the V cycle as conjugate gradients need them: symmetric, positive, and nearer to the solution.
#include "solver/linear/preconditioner/multigrid.hpp"

#include "solver/linear/preconditioner/stencil_level.hpp"
#include "tests/solver/linear_bench.hpp"

namespace talus::solver::testing {
namespace {

using Bench = LinearBench<double, CpuDevice, Linear>;

StoredColumns<double> columns_of(Bench& bench) {
  return {bench.grid.view(), bench.grid.active_list(), bench.grid.active_blocks()};
}

TEST(Multigrid, is_symmetric_and_positive_on_one_grid_and_on_several) {
  Bench bench({ShapeKind::linear});
  for (const bool coarser : {false, true}) {
    Multigrid<double, CpuDevice, Linear> multigrid(bench.device, coarser);
    const HeldNodes held = bench.held();
    multigrid.refresh(bench.from(), bench.elements, columns_of(bench), held);
    EXPECT_EQ(multigrid.grids() > 1, coarser);
    EXPECT_GT(multigrid.bytes(), 0u);
    const NodeVector<CpuDevice> a = bench.right_side();
    auto other = random_vectors(bench.count, 1e4, 21);
    const auto freed = bench.freed.download();
    for (std::size_t n = 0; n < other.size(); ++n) other[n] = freed[n] * other[n];
    NodeVector<CpuDevice> b(bench.device), za(bench.device), zb(bench.device);
    b.upload(other);
    za.upload(std::vector<Vec3<double>>(other.size()));
    zb.upload(std::vector<Vec3<double>>(other.size()));
    multigrid.apply(a, za);
    multigrid.apply(b, zb);
    const double size = std::sqrt(dot(a, za) * dot(b, zb));
    EXPECT_GT(dot(a, za), 0);
    EXPECT_GT(dot(b, zb), 0);
    EXPECT_NEAR(dot(a, zb), dot(b, za), 1e-10 * size);  // rounding of factors of a few thousand blocks
  }
}

TEST(StencilLevel, comes_nearer_to_the_solution_by_sweeps) {
  Bench bench({ShapeKind::linear});
  StencilLevel<double, CpuDevice, Linear> level(bench.device);
  level.build(bench.elements, columns_of(bench), bench.count);
  const HeldNodes held = bench.held();
  level.assemble(bench.elements, bench.from(), held);
  level.factorise();
  EXPECT_EQ(level.nodes(), bench.count);
  const NodeVector<CpuDevice> b = bench.right_side();
  NodeVector<CpuDevice> x(bench.device), r(bench.device);
  x.upload(std::vector<Vec3<double>>(static_cast<std::size_t>(bench.count)));
  r.upload(std::vector<Vec3<double>>(static_cast<std::size_t>(bench.count)));
  const auto residual = [&] {
    level.measure_residual(b, x, r);
    return std::sqrt(dot(r, r));
  };
  const double first = residual();
  for (int pair = 0; pair < 20; ++pair) {
    level.sweep(b, x, true);
    level.sweep(b, x, false);
  }
  EXPECT_LT(residual(), 0.5 * first);
}

}  // namespace
}  // namespace talus::solver::testing
