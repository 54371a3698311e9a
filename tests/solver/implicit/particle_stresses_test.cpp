// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The internal force of the particles: none without strain, in balance under any, and linear where strains are small.
#include "solver/implicit/particle_stresses.hpp"

#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

using Stresses = ParticleStresses<double, CpuDevice, PartsBench::Shape>;

/// The forces [N] of the bench's particles for a displacement of its nodes [m].
std::vector<Vec3<double>> forces(PartsBench& bench, const std::vector<Vec3<double>>& u) {
  const auto parts = bench.parts();
  Buffer<double, CpuDevice> mass(bench.device);
  mass.upload(std::vector<double>(u.size(), 1e6));  // so that no node is light, and none on springs
  Stresses stresses(parts, mass);
  stresses.group();
  stresses.begin(0.01);
  NodeVector<CpuDevice> moved(bench.device), sums(bench.device);
  moved.upload(u);
  sums.upload(std::vector<Vec3<double>>(u.size()));
  stresses.measure(moved, sums, true, false);
  return sums.download();
}

TEST(ParticleStresses, are_none_where_the_body_moves_as_a_whole) {
  PartsBench bench(options_of(Integrator::newmark));
  const auto count = static_cast<std::size_t>(bench.grid.nodes());
  for (const Vec3<double>& f : forces(bench, std::vector<Vec3<double>>(count, {0.1, -0.2, 0.3})))
    EXPECT_NEAR(length(f), 0, 1e-8);  // rounding of strains at 1e-16 times a stiffness of 1e6 Pa, some cells
}

TEST(ParticleStresses, balance_one_another_under_any_strain) {
  PartsBench bench(options_of(Integrator::newmark));
  std::vector<Vec3<double>> u(static_cast<std::size_t>(bench.grid.nodes()));
  for (std::size_t n = 0; n < u.size(); ++n) {
    const double angle = static_cast<double>(n);
    u[n] = {0.01 * std::sin(angle), 0.01 * std::cos(2 * angle), 0};
  }
  Vec3<double> sum{};
  double size = 0;
  for (const Vec3<double>& f : forces(bench, u)) {
    sum += f;
    size += length(f);
  }
  EXPECT_GT(size, 1e3);
  EXPECT_LT(length(sum), 1e-12 * size);
}

TEST(ParticleStresses, round_tangents_only_where_newton_corrects_them) {
  ImplicitControls c;
  EXPECT_TRUE(Stresses::rounds(c));
  c.newton_iterations = 1;
  EXPECT_FALSE(Stresses::rounds(c));
  c.newton_iterations = 30;
  c.linear_solver = LinearSolver::cholesky;
  EXPECT_FALSE(Stresses::rounds(c));
}

}  // namespace
}  // namespace talus::solver::testing
