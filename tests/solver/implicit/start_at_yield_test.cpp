// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A step of one linear solve that begins with sand on its yield cone: its tangent is that of the way which the nodes
// are about to go (T17c), not what rounding makes of it.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "solver/implicit/implicit_step.hpp"
#include "solver/options/solve.hpp"
#include "tests/solver/parts_bench.hpp"

namespace talus::solver::testing {
namespace {

SolveOptions one_solve() {
  SolveOptions o = options_of(Integrator::newmark);
  o.material.model = MaterialModel::drucker_prager;
  o.material.friction_angle = 30;
  o.implicit.newton_iterations = 1;
  return o;
}

/// The block with every point's stress on the cone, where a step has left it, and moving as a swirl that loads some of
/// them and unloads others. `share`: of each stress, by which rounding has moved it up or down.
struct YieldedBench : PartsBench {
  explicit YieldedBench(const SolveOptions& o, double share = 0) : PartsBench(o) {
    ParticleState s = points.download();
    std::mt19937 engine(5);
    std::uniform_real_distribution<double> u(-1, 1);
    const auto column = [&](double size) { return Vec3<double>{size * u(engine), size * u(engine), size * u(engine)}; };
    for (std::size_t p = 0; p < s.size(); ++p) {
      MaterialState<double> state;
      while (!(state.plastic_shear > 0)) {
        state = {.elastic = {}, .log_volume = -0.02};
        advance_material(materials.list[0], {column(0.01), column(0.01), column(0.01)}, 0.01, state);
        if (!(state.log_volume < -0.01)) state.plastic_shear = 0;
      }
      const double moved = 1 + (u(engine) > 0 ? share : -share);
      const Sym3<double>& e = state.elastic;
      const double strain[6] = {e.xx, e.yy, e.zz, e.xy, e.yz, e.xz};
      for (std::size_t q = 0; q < 6; ++q) s.elastic[q][p] = strain[q] * moved;
      s.log_volume[p] = state.log_volume;
      s.velocity[0][p] = std::sin(0.9 * s.cell[2][p] + 0.5 * s.cell[1][p]);
      s.velocity[1][p] = std::cos(0.8 * s.cell[0][p]);
      s.velocity[2][p] = 0.5 * std::sin(0.7 * s.cell[0][p]);
    }
    points.upload(s);
    grid.fit(points, 0);
  }
};

/// The displacement of the farthest point in one solve [m].
double way_of_one_solve(double share) {
  YieldedBench bench(one_solve(), share);
  ImplicitStep<double, CpuDevice, PartsBench::Shape> step(bench.parts(),
                                                          {bench.device, bench.settings.common.bed, bench.scene.bed});
  step.group({});
  step.begin({.start = 0, .step = 0.05});
  EXPECT_TRUE(step.solve().converged);
  return step.farthest_motion().length;
}

TEST(StartAtYield, one_solve_does_not_hang_on_rounding) {
  // Stresses moved by 1e-14 move the solution by what the linear solver leaves, 1e-8 of its right-hand side.
  const double way = way_of_one_solve(0);
  ASSERT_GT(way, 1e-3);
  EXPECT_NEAR(way_of_one_solve(1e-14), way, 1e-6 * way) << "at " << way;
}

/// Forces [N] and their changes along a way of the nodes, from the stresses and tangents of the bench's points.
class ForcesAhead {
 public:
  explicit ForcesAhead(YieldedBench& bench) : bench_(bench), parts_(bench.parts()) {
    mass_.upload(std::vector<double>(nodes(), 1e6));  // so that no node is light, and none on springs
    stresses_.group();
    stresses_.begin(0.01);
  }
  std::size_t nodes() const { return static_cast<std::size_t>(bench_.grid.nodes()); }

  /// The internal force for the displacement u.
  std::vector<Vec3<double>> at(const std::vector<Vec3<double>>& u) {
    u_.upload(u);
    sums_.upload(std::vector<Vec3<double>>(nodes()));
    stresses_.measure(u_, sums_, false, false);
    return sums_.download();
  }
  /// What the tangent at rest, with `way` ahead, makes of that way.
  std::vector<Vec3<double>> along(const std::vector<Vec3<double>>& way) {
    using Product = TangentTimes<double, PartsBench::Shape>;
    NodeVector<CpuDevice> ahead(bench_.device);
    ahead.upload(way);
    u_.upload(std::vector<Vec3<double>>(nodes()));
    sums_.upload(std::vector<Vec3<double>>(nodes()));
    stresses_.measure(u_, sums_, true, false, ahead.data());
    sums_.fill_zero();
    scatter_points(bench_.device, bench_.points.count(), bench_.grid.groups(),
                   ScatterForces<double, PartsBench::Shape, Product>{{bench_.grid.view(), bench_.points.view()},
                                                                     Product{stresses_.view().tangents, ahead.data()},
                                                                     sums_.data()});
    return sums_.download();
  }

 private:
  YieldedBench& bench_;
  StepParts<double, CpuDevice, PartsBench::Shape> parts_;
  Buffer<double, CpuDevice> mass_{bench_.device};
  ParticleStresses<double, CpuDevice, PartsBench::Shape> stresses_{parts_, mass_};
  NodeVector<CpuDevice> u_{bench_.device}, sums_{bench_.device};
};

/// Shear of the layers along the slope of 0.6 and across it. It leaves the volume alone, on which the frozen yield
/// stress depends.
std::vector<Vec3<double>> shear_of_layers(const YieldedBench& bench) {
  std::vector<Vec3<double>> way(static_cast<std::size_t>(bench.grid.nodes()));
  for (const BlockSlot& slot : slots_of(bench.grid)) {
    for (int n = 0; slot.offset >= 0 && n < slot.layers * block_columns; ++n) {
      const double layer = slot.first_layer + n / block_columns, along = 0.01 * std::sin(1.3 * layer);
      way[static_cast<std::size_t>(slot.offset + n)] = {along, 0.01 * std::cos(0.7 * layer), -0.6 * along};
    }
  }
  return way;
}

TEST(StartAtYield, tangent_is_the_derivative_of_the_forces_along_the_way_ahead) {
  YieldedBench bench(one_solve());
  ForcesAhead forces(bench);
  const std::vector<Vec3<double>> way = shear_of_layers(bench);
  std::vector<Vec3<double>> little(way.size());
  constexpr double share = 1e-6;  // of strains of some 1e-2
  for (std::size_t n = 0; n < way.size(); ++n) little[n] = way[n] * share;
  const auto product = forces.along(way), here = forces.at(std::vector<Vec3<double>>(way.size())),
             there = forces.at(little);
  double off = 0, size = 0;
  for (std::size_t n = 0; n < way.size(); ++n) {
    const Vec3<double> change = (there[n] - here[n]) * (1 / share), error = change - product[n];
    off += dot(error, error);
    size += dot(change, change);
  }
  // The forces are curved by the share over what stresses are of stiffness, 1e-6 / 1e-2.
  EXPECT_LT(std::sqrt(off / size), 1e-3);
}

}  // namespace
}  // namespace talus::solver::testing
