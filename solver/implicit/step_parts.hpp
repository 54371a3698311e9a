// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the objects of an implicit step work on together.
#pragma once

#include "solver/boundary/contact_impulses.hpp"
#include "solver/boundary/surface_contact.hpp"
#include "solver/grid/sparse_grid.hpp"
#include "solver/implicit/controls.hpp"
#include "solver/integrator/settings.hpp"
#include "solver/material/material.hpp"
#include "solver/parallel/sums.hpp"
#include "solver/state/particles.hpp"

namespace talus::solver {

/// The size of the cells and what they hold when they are full.
struct CellMeasures {
  double spacing, layer_height;  ///< [m]
  double layer_mass;             ///< of a full layer over a square metre [kg/m2]
  double full_base;              ///< mass of a base node under a full layer [kg]
};

/// The particles, the grid and what the mass can touch, which belong to the integrator, the settings of all
/// integrators and the controls of implicit ones.
template <class Real, class Device, class Shape>
struct StepParts {
  Device device;
  const IntegratorSettings& settings;
  const ImplicitControls& controls;
  Particles<Real, Device>& points;
  SparseGrid<Real, Device>& grid;
  Materials<Real>& materials;
  bool dilatant;  ///< plastic flow changes the volume
  SurfaceContact<Real, Device, Shape>& surfaces;
  ContactImpulses<Real, Device, Shape>& impulses;
  SumSpace<Device>& sums;
  CellMeasures cell;
};

}  // namespace talus::solver
