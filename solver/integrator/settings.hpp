// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What integrators and their kernels see of a recipe: SI units, coefficients instead of angles, presets resolved.
// scene/settings.hpp makes them of the options, once.
#pragma once

#include <type_traits>
#include <vector>

#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/plane_walls.hpp"
#include "solver/boundary/separation.hpp"
#include "solver/grid/shape_functions.hpp"
#include "solver/integrator/loads.hpp"
#include "solver/material/material.hpp"
#include "solver/state/particles.hpp"

namespace talus::solver {

/// The settings of the length of explicit steps, (T11).
struct StepSettings {
  double cfl = 0.5;          ///< step size over the CFL step [-]
  double largest = 1;        ///< upper bound [s]
  double fastest_wave = 0;   ///< of any of the materials [m/s]
  double initial_speed = 0;  ///< of the mass [m/s]
  double kappa = 0;          ///< of inertia that is implicit by columns (T6a); 0: explicit steps
};

/// The settings of the way that velocity passes between particles and grid, (T7) and (T8).
struct TransferSettings {
  bool affine = true;            ///< particles carry the affine part of their velocity (APIC)
  bool remaps_velocity = false;  ///< the particles' new velocity goes back to the grid before the strain (MUSL)
  double time = 0;               ///< over which velocity finer than the grid decays [s]; 0: at every step
};

/// The settings of gravity.
struct GravitySettings {
  Vec3<double> acceleration{0, 0, -9.81};  ///< [m/s2]
  double ramp = 0;                         ///< time over which it grows to its full size [s]; 0: there from the start
};

/// The materials of a scene, in the precision of the state.
struct MaterialSettings {
  Materials<double> in_double;
  Materials<float> in_single;
  bool densities_differ = false;

  /// The materials in the precision `Real`.
  template <class Real>
  const Materials<Real>& in() const {
    if constexpr (std::is_same_v<Real, double>) {
      return in_double;
    } else {
      return in_single;
    }
  }
};

/// The settings that all integrators read.
struct IntegratorSettings {
  ShapeKind shape = ShapeKind::quadratic;
  ParticleNeeds needs;  ///< what the scheme, the materials and the loads ask of the points
  StepSettings steps;
  TransferSettings transfer;
  GravitySettings gravity;
  double damping = 0;          ///< Cundall's local factor [-]
  double map_threshold = 0.1;  ///< thickness from which speed, pressure and arrival count [m]
  bool energy_budget = false;  ///< losses to the bed, to plastic flow, to damping and in the transfer are summed
  bool deterministic = false;  ///< the same bits on every run on a GPU too
  MaterialSettings materials;
  BaseFriction<double> bed;  ///< where the scene has no numbers of its own for a column
  SeparationSettings separation;
  std::vector<PlaneWall> walls;
  std::vector<Load> loads;
};

}  // namespace talus::solver
