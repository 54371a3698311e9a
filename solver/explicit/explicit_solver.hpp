// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The explicit step. Included by the files that instantiate it.
#pragma once

#include "solver/explicit/make_explicit_solver.hpp"
#include "solver/explicit/update_columns.hpp"
#include "solver/integrator/batch_solver.hpp"

namespace talus::solver {

/// The integrator of explicit steps.
template <class Real, class Device, class Shape>
class ExplicitSolver final : public BatchSolver<Real, Device, Shape> {
  using Base = BatchSolver<Real, Device, Shape>;
  using Base::device_, Base::forces_, Base::grid_, Base::nodes_, Base::settings_;

 public:
  ExplicitSolver(const Device& device, const Scene& scene, const IntegratorSettings& settings, const SolverState& state)
      : Base(device, scene, settings, state, true) {
    this->start(state);
  }

 private:
  /// Whether momentum and internal forces are scattered apart.
  bool forces_apart() const {
    return settings_.remaps_velocity() || settings_.decay_time > 0 || settings_.damping > 0 || settings_.energy_budget;
  }

  void resize_nodes(std::size_t count) override {
    if (forces_apart()) forces_.resize(count);
  }

  void move_nodes() override {
    const NodeInertia<Device> inertia(device_);
    if (!forces_apart()) {
      this->template scatter<Scatter::impulse>();
      return this->update(nullptr, inertia, [&] { update_nodes<NodeContent::impulse, false>(); });
    }
    this->template scatter<Scatter::force>();
    this->update(forces_.data(), inertia, [&] {
      settings_.energy_budget ? update_nodes<NodeContent::force, true>() : update_nodes<NodeContent::force, false>();
    });
  }

  template <NodeContent content, bool counts>
  void update_nodes() {
    for_each_column<block_columns>(device_, grid_.active_blocks(),
                                   UpdateColumns<Real, content, counts>{this->boundary(), nodes_.data(), forces_.data(),
                                                                        static_cast<Real>(settings_.damping)});
  }
};

/// The definition for the files in instances/; see make_explicit_solver.hpp.
template <class Real, class Shape>
std::unique_ptr<Solver> make_explicit_solver(const Scene& scene, const IntegratorSettings& settings,
                                             const AnyDevice& device, const SolverState& state) {
  return make_solver_on<ExplicitSolver, Real, Shape>(device, scene, settings, state);
}

}  // namespace talus::solver
