// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The numerical scheme that all integrators share: numbers, grid, transfer, step size.
#pragma once

#include <optional>

#include "common/recipe/recipe.hpp"
#include "solver/grid/shape_functions.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

/// The precision of the points' state.
enum class Precision { single_, double_ };
/// The transfer of velocity: affine (Jiang et al. 2015) or not (Brackbill & Ruppel 1986); see (T7) and (T8).
enum class Transfer { apic, flip };
/// The time at which stress is updated: after the nodes' step (USL), or after velocity went back to them (MUSL).
enum class StressUpdate { last, modified };  ///< USL, MUSL

/// The share of a step's change of velocity that springs between layers feel (T6a); below 0.25 steps are unstable.
inline constexpr double column_kappa = 0.3;

/// The step over the CFL step, unless the recipe says otherwise.
inline constexpr double default_cfl = 0.5;

/// The keys of [solve] for the numerical scheme that all integrators share.
struct SchemeOptions {
  Precision precision = Precision::double_;
  Mapping mapping = Mapping::terrain_following;
  ShapeKind shape = ShapeKind::quadratic;
  Transfer transfer = Transfer::apic;
  std::optional<double> transfer_time;  ///< [s]; none: transfer_time_of()
  StressUpdate stress_update = StressUpdate::last;
  double damping = 0;  ///< Cundall's local factor
  double cfl = default_cfl;
  double largest_step = 1;  ///< [s]

  /// Whether particles carry the affine part of their velocity.
  bool affine() const { return transfer == Transfer::apic; }
  /// Whether the particles' new velocity goes back to the grid before the strain.
  bool remaps_velocity() const { return stress_update == StressUpdate::modified; }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::solver
