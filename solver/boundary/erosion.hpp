// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ground that is eroded by rate (T52): nodes inside what is left of it are at rest, and what flows over it lowers it.
#pragma once

#include <climits>
#include <cmath>

#include "solver/boundary/column_flow.hpp"
#include "solver/state/map_view.hpp"

namespace talus {

/// The highest layer of nodes that lies in a depth [m] of ground, to the nearest; below all where there is none.
TALUS_HD int ground_layer(double ground, double layer_height) {
  const double layers = ground / layer_height;
  return layers > 0.5 ? static_cast<int>(floor(layers + 0.5)) : INT_MIN;
}

/// One thread: one column. The mass over ground takes E times its thickness times its speed of it per time.
template <class Real, class Nodes>
struct ErodeColumns {
  GridView<Real> grid;
  const int* active;
  Nodes nodes;
  const Clock* clock;
  ColumnDensity<Real> density;
  MapView maps;
  double rate;  ///< E [1/m]

  TALUS_HD void operator()(int c) const {
    if (clock->alarms.halt != running) return;
    const ColumnNodes at = ColumnNodes::find(grid, active, c);
    if (!at.in_domain() || !(maps.ground[at.column] > 0)) return;
    const LyingMatter<Real> matter = matter_in(nodes, at, at.begin(), at.end());
    if (!(matter.mass > Real(0))) return;
    const double mass = static_cast<double>(matter.mass), spacing = static_cast<double>(grid.spacing);
    const double discharge =
        static_cast<double>(length(matter.momentum)) / (density.of(at.column, mass) * spacing * spacing);
    const double left = maps.ground[at.column] - rate * discharge * clock->step_size;
    maps.ground[at.column] = left > 0 ? left : 0;
  }
};

}  // namespace talus
