// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The column-implicit step. Included by the files that instantiate it.
#pragma once

#include <algorithm>

#include "solver/column_implicit/solve_columns.hpp"
#include "solver/integrator/batch_solver.hpp"
#include "solver/integrator/make_solvers.hpp"

namespace talus::solver {

/// The integrator of steps whose inertia is implicit along the columns of the grid (T6a).
template <class Real, class Device, class Shape>
class ColumnImplicitSolver final : public BatchSolver<Real, Device, Shape, false> {
  using Base = BatchSolver<Real, Device, Shape, false>;
  using Base::clock_, Base::device_, Base::grid_, Base::settings_;

 public:
  ColumnImplicitSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings,
                       const SolverState& state)
      : Base(device, scene, settings, state), softer_(softer(scene, settings)) {
    this->start(state);
  }

 private:
  void resize_nodes(std::size_t count) override { mobilities_.resize(count); }
  std::size_t node_bytes() const override { return Base::node_bytes() + mobilities_.bytes(); }

  void update_nodes() override {
    const SolvedColumns<Real> solved{.grid = grid_.view(),
                                     .active = grid_.active_list(),
                                     .clock = clock_.data(),
                                     .mobilities = mobilities_.data(),
                                     .forces = this->forces(),
                                     .kappa = kappa()};
    this->update(this->forces(), ColumnInertia<Real, Device>(device_, solved, grid_.active_blocks()), [&] {
      if (settings_.energy_budget) return solve_columns<true>();
      solve_columns<false>();
    });
  }

  template <bool counts>
  void solve_columns() {
    for_each(device_, grid_.active_blocks() * block_columns,
             SolveColumns<Real, counts>{this->boundary(this->forces()), this->nodes(), this->forces(),
                                        mobilities_.data(), static_cast<Real>(settings_.damping), kappa(), softer_});
  }

  Real kappa() const { return static_cast<Real>(settings_.kappa); }

  /// The springs along the bed over those across it (T6b) [-]: the modulus of shear over that of uniaxial strain, of
  /// the material where that is most. Where columns meet more than their bed (walls across z, contact points), or stand
  /// not across it (Cartesian grids), springs are the same in all directions, which is an upper bound too.
  static Real softer(const Scene& scene, const IntegratorSettings& settings) {
    const auto across_z = [](const PlaneWall& wall) { return wall.axis == 2; };
    if (scene.grid.mapping == Mapping::cartesian || scene.contacts.size() > 0 ||
        std::ranges::any_of(settings.walls, across_z))
      return Real(1);
    Real most = 0;
    for (const Material<Real>& m : settings.materials.in<Real>().list) {
      const Real uniaxial = m.density * m.wave_speed * m.wave_speed;
      if (uniaxial > Real(0)) most = std::max(most, m.shear_modulus / uniaxial);
    }
    return most;
  }

  Real softer_;
  Buffer<Mobility<Real>, Device> mobilities_{device_};  ///< of the nodes
};

template <class Real, class Shape>
std::unique_ptr<Solver> ColumnImplicitSolvers<Real, Shape>::make(const Scene& scene, const IntegratorSettings& settings,
                                                                 const AnyDevice& device, const SolverState& state) {
  return make_solver_on<ColumnImplicitSolver, Real, Shape>(device, scene, settings, state);
}

}  // namespace talus::solver
