// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A mass below a level of still water (T51): it weighs less, moves some of the water with it, and is dragged at its
// surface. There are no waves.
#pragma once

#include "solver/state/grid_view.hpp"

namespace talus {

/// Still water up to a level, against a mass of one density.
template <class Real>
struct Submersion {
  Real level = Real(-1e30);  ///< over the datum of the ground [m]
  Real lift = 0;             ///< density of the water over that of the mass [-]
  Real added = 0;            ///< mass of the water that moves along, over that of the mass [-]
  Real drag = 0;             ///< half its density times the coefficient of drag [kg/m3]

  /// The same in another precision.
  template <class To>
  Submersion<To> as() const {
    return {static_cast<To>(level), static_cast<To>(lift), static_cast<To>(added), static_cast<To>(drag)};
  }
  TALUS_HD bool on() const { return lift > Real(0); }
  /// The share below the level of what is about a height over the datum, within half a `layer` to either side [-].
  TALUS_HD Real share(Real height, Real layer) const {
    const Real below = (level - height) / layer + Real(0.5);
    return below < Real(0) ? Real(0) : below < Real(1) ? below : Real(1);
  }
  /// The same of node k of a column.
  TALUS_HD Real share(const GridView<Real>& grid, int column, int k) const {
    return on() ? share(grid.terrain[column] + Real(k) * grid.layer_height, grid.layer_height) : Real(0);
  }
  /// The inertia of a mass over its own [-].
  TALUS_HD Real inertia(Real share) const { return Real(1) + added * share; }
  /// The weight of a mass over its own [-].
  TALUS_HD Real weight(Real share) const { return Real(1) - lift * share; }
};

}  // namespace talus
