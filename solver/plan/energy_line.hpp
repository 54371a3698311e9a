// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The energy line of a scene: what bounds the speed of a flow, and where it can go.
#pragma once

#include "common/domain/domain.hpp"
#include "solver/integrator/scene.hpp"

namespace talus::solver {

struct SolveOptions;

/// A cone that falls from the top of what is released by the least friction the flow can meet (Heim 1932).
struct EnergyLine {
  double x = 0, y = 0, z = -1e30;  ///< the highest place of what is released [m]
  double friction = 0;             ///< the cone's slope [-]

  /// Its height above the ground at a cell of the terrain, negative where nothing gets; NaN outside the terrain [m].
  double head(const Raster& terrain, int column, int row) const;
  /// The largest height above the ground; 0 where nothing is released [m].
  double largest_head(const Raster& terrain) const;
};

/// What bounds the speed of a flow: energy line, speed at the start and shaking; and its depth at the start.
struct SpeedBound {
  EnergyLine line;
  double fall = 0;   ///< that the energy line allows somewhere in the domain [m/s]
  double speed = 0;  ///< with the speed at the start and the range of the ground's own velocity [m/s]
  double depth = 0;  ///< of the highest point of what is released, above the bed [m]
};

/// The energy line of a domain and of what enters it.
EnergyLine energy_line_of(const Domain& domain, const SolveOptions& options, const Inflow& inflow);

/// The bound of a scene, whose inflows and shaking are known.
SpeedBound speed_bound(const Domain& domain, const SolveOptions& options, const Scene& scene);

/// How much the ground bends within a cell, over the thickness of what is released (its median by volume): the mean,
/// where the energy line lies above the ground, of the rise of an arc over its chord of a cell's width, |b' - b| h / 8
/// with b and b' the slopes of neighbouring cells [-]. 0 where nothing is released.
double bend_over_thickness(const Domain& domain, const EnergyLine& line);

/// How much a layer is thinner across itself than upwards: the mean of 1 + b_x^2 + b_y^2 over the slopes b of the
/// ground, where the energy line lies above it [-]. 1 where nothing is released.
double steepness(const Domain& domain, const EnergyLine& line);

}  // namespace talus::solver
