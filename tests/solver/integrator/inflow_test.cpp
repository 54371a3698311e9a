// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over pulses, and points that are added to a solver.
#include "solver/integrator/inflow.hpp"

#include "solver/options/solve.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

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
