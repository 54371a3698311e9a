// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What integrators and their kernels see of a recipe, all of them and implicit ones: groups of its options as they are,
// and what follows from the others (coefficients instead of angles, presets resolved). scene/settings.hpp makes that of
// the options, once.
#pragma once

#include <optional>
#include <type_traits>
#include <vector>

#include "solver/boundary/submersion.hpp"
#include "solver/boundary/walls.hpp"
#include "solver/material/material.hpp"
#include "solver/options/implicit.hpp"
#include "solver/options/loads.hpp"
#include "solver/options/output.hpp"
#include "solver/options/scheme.hpp"
#include "solver/state/particles.hpp"
#include "solver/water/pore_water.hpp"

namespace talus::solver {

/// The materials of a scene, in the precision of the state.
struct MaterialSettings {
  Materials<double> in_double;
  Materials<float> in_single;
  bool densities_differ = false;

  template <class Real>
  const Materials<Real>& in() const {
    if constexpr (std::is_same_v<Real, double>) {
      return in_double;
    } else {
      return in_single;
    }
  }
};

/// The settings that all integrators read: options of the recipe, and what is made of others.
struct IntegratorSettings : SchemeOptions, GravityOptions, OutputOptions {
  ParticleNeeds needs = {};  ///< what the scheme, the materials and the loads ask of the points
  double fastest_wave = 0;   ///< of any of the materials [m/s]
  double kappa = 0;          ///< of inertia that is implicit by columns (T6a); 0: explicit steps
  double decay_time = 0;     ///< over which velocity finer than the grid decays (T8) [s]; 0: at every step
  MaterialSettings materials = {};
  BaseFriction<double> bed = {};  ///< where the scene has no numbers of its own for a column
  std::vector<PlaneWall> walls = {};
  std::vector<LoadOptions> loads = {};
  Submersion<double> submersion = {};  ///< its level is an elevation
  std::optional<PoreWater<double>> water = {};
  double erosion_rate = 0;  ///< E of (T52) [1/m]; 0: ground is eroded as its strength has it
  double water_ratio = -1;  ///< of the pressure to the load at the start; negative: hydrostatic
};

/// How implicit steps are taken.
struct ImplicitControls : ImplicitOptions, NewtonScheme {
  bool dynamic = true;  ///< with inertia (Newmark); else a sequence of equilibria
  /// It is asked between iterations, of linear systems too, whether the step is given up; null: never.
  bool (*give_up)() = nullptr;
  int patience = 0;  ///< iterations without a halving after which a step is given up; 0: all of them

  /// Whether the step is given up: its iterations end as they are, and nothing of it is kept.
  bool gives_up() const { return give_up && give_up(); }
  /// Whether a step is one linear solve with the tangent at its start.
  bool once() const { return newton_iterations == 1; }
};

}  // namespace talus::solver
