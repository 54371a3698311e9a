// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every integrator has, on a body that is never moved; sums over pulses, and points that are added.
#include "solver/integrator/point_solver.hpp"

#include <numeric>

#include "solver/integrator/inflow.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// An integrator that makes no step.
class StandingStill final : public PointSolver<double, CpuDevice, Quadratic> {
 public:
  StandingStill(const Scene& scene, const IntegratorSettings& settings, const SolverState& state)
      : PointSolver(CpuDevice::make(), scene, settings, state, settings.needs, {}) {
    fit(0);
  }
  BatchReport advance() override { return {}; }
  void add(const ParticleState&, double) override {}
  using PointSolver::full_base, PointSolver::layer_mass, PointSolver::set_walls;
  const double* columns() {
    measure_columns();
    return measures_.column_volumes();
  }
  WallNodes walls() const { return grid_.view().walls; }
};

struct Still {
  Scene scene;
  IntegratorSettings settings;
  SolverState start;

  Still() {
    Domain d = ground(12, 10, 2.0, 0.5, [](double, double) { return 5.0; });
    fill(d, {8, 12, 6, 10, 0, 1.5});
    SolveOptions o;
    o.material.density = 1500;
    scene = make_scene(d, o);
    settings = make_settings(o, scene.grid).common;
    settings.walls = {{.axis = 0, .position = 7, .to = 1}};
    start = first_state(scene, settings);
  }
  StandingStill make() const { return {scene, settings, start}; }
};

TEST(PointSolver, keeps_particles_clock_and_maps_for_a_checkpoint) {
  Still still;
  still.start.clock.time = 3;
  still.start.maps.peak_speed[17] = 8;
  StandingStill solver = still.make();
  solver.set_next_event(4.5);
  const SolverState state = solver.state();
  EXPECT_EQ(state.clock.time, 3);
  EXPECT_EQ(state.clock.next_event, 4.5);
  EXPECT_EQ(solver.clock().next_event, 4.5);
  EXPECT_EQ(state.maps.peak_speed, still.start.maps.peak_speed);
  EXPECT_EQ(solver.particle_count(), static_cast<int>(still.scene.points.size()));
  EXPECT_EQ(std::accumulate(state.points.volume.begin(), state.points.volume.end(), 0.0), 24);
}

TEST(PointSolver, measures_the_whole_mass) {
  const Still still;
  StandingStill solver = still.make();
  EXPECT_NEAR(solver.energies().volume, 24, 1e-12);
  const std::vector<double> thickness = solver.thickness();
  EXPECT_NEAR(4 * std::accumulate(thickness.begin(), thickness.end(), 0.0), 24, 1e-12);
  EXPECT_EQ(solver.layer_mass(), 1500 * 0.5);
  EXPECT_EQ(solver.full_base(), Quadratic::edge_share * 1500 * 2 * 2 * 0.5);
}

TEST(PointSolver, measures_volumes_over_columns_where_densities_differ_alone) {
  Still still;
  EXPECT_EQ(still.make().columns(), nullptr);
  still.settings.materials.densities_differ = true;
  EXPECT_NE(still.make().columns(), nullptr);
}

TEST(PointSolver, lets_the_grid_meet_the_walls_of_a_time) {
  const Still still;
  StandingStill solver = still.make();
  EXPECT_EQ(solver.set_walls<double>(1.5).count, 0);
  EXPECT_EQ(solver.walls().west, -WallNodes::far);
  EXPECT_EQ(solver.set_walls<double>(0.5).count, 1);
  EXPECT_EQ(solver.walls().west, 3);  // 7 m, nodes at 1 m, 3 m, ...
}

TEST(PointSolver, lists_its_memory_by_owner) {
  const Still still;
  const MemoryShares shares = still.make().memory();
  ASSERT_GE(shares.size(), 3u);
  EXPECT_EQ(shares[0].first, "points");
  EXPECT_EQ(shares[1].first, "grid");
  EXPECT_EQ(shares[2].first, "maps and records");
  EXPECT_GE(shares[2].second, 4 * 120 * sizeof(double));
}

TEST(Inflow, sums_up_the_pulses_that_have_passed) {
  Inflow inflow;
  inflow.points.resize(5);
  for (std::size_t p = 0; p < 5; ++p) inflow.points.id[p] = static_cast<int>(10 + p);
  inflow.pulses = {{.time = 1, .first = 0, .count = 3, .volume = 2, .energy = 7, .momentum = {1, 0, 0}},
                   {.time = 2, .first = 3, .count = 2, .volume = 5, .energy = 1, .momentum = {2, 1, 0}}};
  EXPECT_EQ(inflow.points_in(0), 0u);
  EXPECT_EQ(inflow.points_in(1), 3u);
  EXPECT_EQ(inflow.points_in(2), 5u);
  EXPECT_EQ(inflow.volume(1), 2);
  EXPECT_EQ(inflow.volume(2), 7);
  EXPECT_EQ(inflow.energy(2), 8);
  EXPECT_EQ(inflow.momentum(2).x, 3);
  EXPECT_EQ(inflow.points_of(inflow.pulses[1]).id, (std::vector<int>{13, 14}));
}

class AddedPoints : public InEachPlace {};

TEST_P(AddedPoints, are_behind_those_that_were_there_and_change_nothing_of_them) {
  Domain d = ground(16, 16, 1.0, 1.0, [](double, double) { return 0.0; });
  fill(d, {4, 8, 4, 8, 0, 2});
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark}) {
    for (const Precision precision : {Precision::double_, Precision::single_}) {
      SolveOptions o;
      o.integrator = integrator;
      o.precision = precision;
      const Scene scene = make_scene(d, o);
      const auto solver = make_solver(scene, o, GetParam());
      run_to(*solver, 0.02);
      const ParticleState before = solver->state().points;
      const Energies energies = solver->energies();
      ParticleState more = scene.points;  // elsewhere, and often enough that arrays must grow
      for (int& i : more.cell[0]) i += 5;
      for (int time = 0; time < 5; ++time) {
        for (int& id : more.id) id += static_cast<int>(scene.points.size());
        solver->add(more, 1.0);
      }
      EXPECT_EQ(solver->particle_count(), static_cast<int>(6 * scene.points.size()));
      EXPECT_NEAR(solver->energies().volume, 6 * energies.volume, 1e-6);
      const ParticleState after = solver->state().points;
      std::vector<std::size_t> place(after.size());
      for (std::size_t p = 0; p < after.size(); ++p) place[static_cast<std::size_t>(after.id[p])] = p;
      for (std::size_t p = 0; p < before.size(); ++p) {
        const std::size_t q = place[static_cast<std::size_t>(before.id[p])];
        EXPECT_EQ(after.velocity[2][q], before.velocity[2][p]);
        EXPECT_EQ(after.elastic[2][q], before.elastic[2][p]);
        EXPECT_EQ(after.offset[2][q], before.offset[2][p]);
      }
    }
  }
}

TALUS_IN_EACH_PLACE(AddedPoints);

}  // namespace
}  // namespace talus::solver::testing
