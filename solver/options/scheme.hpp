// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run simulates: how its steps are taken, from which domain, how long; and the numerical scheme that all
// integrators share: numbers, grid, transfer, step size.
#pragma once

#include <filesystem>
#include <optional>

#include "common/recipe/recipe.hpp"
#include "solver/grid/shape_functions.hpp"
#include "solver/state/grid_view.hpp"

namespace talus::solver {

/// How steps are taken: explicitly, with inertia implicit along columns, by Newmark's scheme, as a sequence of
/// equilibria, or as the run needs it.
enum class Integrator { explicit_, column_implicit, newmark, quasi_static, automatic };
/// The abilities of an integrator's steps; other keys, the scene and the plan ask for these, not for the integrator.
struct StepAbilities {
  bool obey_cfl = false;        ///< their size follows waves and speed, for the first of the steps at least
  bool carry_inertia = false;   ///< the others are a sequence of equilibria
  bool count_losses = false;    ///< what is lost, by its cause
  bool repeat_bits = false;     ///< the same on every run on a GPU
  bool solve_systems = false;   ///< some of the steps at least
  bool average_volume = false;  ///< over the particles of an element, all of the steps
  bool solve_columns = false;   ///< inertia is implicit along the columns of the grid
};
/// The abilities of an integrator's steps.
StepAbilities abilities_of(Integrator integrator);

/// A named set of values for many keys.
enum class Preset { none, reference };

/// The keys of [solve] for what a run simulates.
struct TimeOptions {
  Preset preset = Preset::none;
  Integrator integrator = Integrator::automatic;
  std::optional<double> accuracy;           ///< "auto": share of the deposit that may lie elsewhere
  Integrator flow = Integrator::explicit_;  ///< "auto": steps of a flow; no key, settle_steps() chooses
  int gravity_loading_steps = 0;            ///< quasi-static steps before the start
  std::filesystem::path domain;             ///< empty: OUT/domain.vdb
  double end_time = 60;                     ///< [s]
  double stop_kinetic_fraction = 0;         ///< of its peak; 0: never
  void describe(recipe::Visitor& v);
};

/// The precision of the points' state.
enum class Precision { single_, double_ };
/// The transfer of velocity: affine (Jiang et al. 2015) or not (Brackbill & Ruppel 1986); see (T7) and (T8).
enum class Transfer { apic, flip };
/// The time at which stress is updated: after the nodes' step (USL), or after velocity went back to them (MUSL).
enum class StressUpdate { last, modified };  ///< USL, MUSL

/// The share of a step's change of velocity that springs between layers feel (T6a); below 0.25 steps are unstable.
inline constexpr double column_kappa = 0.3;

/// The explicit step over the CFL step, unless the recipe says otherwise.
inline constexpr double default_cfl = 0.5;

/// The keys of [solve] for the numerical scheme that all integrators share.
struct SchemeOptions {
  Precision precision = Precision::double_;
  Mapping mapping = Mapping::terrain_following;
  ShapeKind shape = ShapeKind::quadratic;
  Transfer transfer = Transfer::apic;
  std::optional<double> transfer_time;  ///< [s]; none: transfer_time_of()
  StressUpdate stress_update = StressUpdate::last;
  double damping = 0;         ///< Cundall's local factor
  std::optional<double> cfl;  ///< none: SolveOptions::step_over_cfl()
  double largest_step = 1;    ///< [s]

  /// Whether particles carry the affine part of their velocity.
  bool affine() const { return transfer == Transfer::apic; }
  /// Whether the particles' new velocity goes back to the grid before the strain.
  bool remaps_velocity() const { return stress_update == StressUpdate::modified; }
  void describe(recipe::Visitor& v);
};

}  // namespace talus::solver
