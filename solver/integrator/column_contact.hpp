// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the bed does to whole columns in explicit steps, beside what its nodes feel: friction of laws that ask for the
// column, tractions, and the hold on columns that would leave it for a low hop.
#pragma once

#include "solver/boundary/bed_hold.hpp"
#include "solver/boundary/column_traction.hpp"
#include "solver/boundary/contact_impulses.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/integrator/solver.hpp"

namespace talus::solver {

/// The nodes of a step with a clock, and the changes of their velocity where the step keeps them.
template <class Real>
using StepNodes = StepColumns<Real, PackedNodes<Real>>;

template <class Real, class Device>
class ColumnContact {
 public:
  /// The constructor takes the bed's friction, what the recipe asks for, the grid, and still water.
  ColumnContact(const Device& device, const BaseFriction<Real>& bed, const IntegratorSettings& settings,
                const GridShape& grid, const Submersion<Real>& submersion)
      : device_(device), traction_(device, bed, grid.columns, grid.rows, submersion), pressed_(device) {
    if (settings.energy_budget)
      pressed_.resize(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
  }

  /// The bed's friction, with the coefficients where they are measured.
  BaseFriction<Real> seen_by(const BaseFriction<Real>& bed) { return traction_.seen_by(bed); }
  /// The columns for what tractions need; null pointers without tractions.
  BedColumns<Real> slowed() { return traction_.slowed(); }
  /// The impulse of the bed on every column [N s], with an energy budget.
  Real* pressed() { return pressed_.data(); }

  /// The method measures the coefficients of friction of a law that asks for the column, as a step begins.
  void measure(const StepNodes<Real>& at, const BaseFriction<Real>& bed) {
    if (!traction_.measures()) return;
    const ProfilePhase<Device> phase(device_, "grid");
    traction_.measure(
        device_, StepColumns<Real, PackedMomenta<Real>>{at.grid, at.active, at.blocks, {at.nodes.nodes}, at.step}, bed);
  }

  /// The method adds what columns have lost by landing to the budget (T24a), once their nodes have met the bed.
  void count_landing(const StepNodes<Real>& at) {
    using Nodes = PackedNodes<Real>;
    const ProfilePhase<Device> phase(device_, "grid");
    for_each(device_, at.count(),
             CountLanding<Real, Nodes>{.grid = at.grid,
                                       .active = at.active,
                                       .nodes = {at.nodes.nodes, nullptr},
                                       .pressed = pressed_.data(),
                                       .step = at.step});
  }

  /// The method holds columns on the ground that would leave it for a low hop (T12c), where the grid follows the
  /// ground. The `first` of the updates that a step makes tells tractions of it.
  void hold(const StepNodes<Real>& at, const Walls<Real>& walls, Real density, bool first) {
    if (at.grid.mapping != Mapping::terrain_following) return;
    const ProfilePhase<Device> phase(device_, "grid");
    for_each(device_, at.count(),
             HoldColumns<Real, PackedNodes<Real>>{.grid = at.grid,
                                                  .active = at.active,
                                                  .nodes = at.nodes,
                                                  .step = at.step,
                                                  .walls = walls,
                                                  .density = density,
                                                  .rise = first ? traction_.slowed().rise : nullptr});
  }

  /// The method lets drag and cohesion of the bed slow what lies on it (T13a).
  void slow(const StepNodes<Real>& at, const BaseFriction<Real>& bed, const ColumnDensity<Real>& density) {
    if (traction_.acts()) traction_.slow(device_, at, bed, true, density);
  }

  void list_memory(MemoryShares& shares) const {
    if (traction_.bytes() > 0) shares.emplace_back("bed's tractions", traction_.bytes());
    if (pressed_.bytes() > 0) shares.emplace_back("contact of columns", pressed_.bytes());
  }

 private:
  Device device_;
  ColumnTraction<Real, Device> traction_;
  Buffer<Real, Device> pressed_;  ///< impulse of the bed on every column [N s]; with a budget
};

}  // namespace talus::solver
