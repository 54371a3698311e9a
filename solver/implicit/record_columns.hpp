// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Maps of an implicit step: thickness and arrival.
#pragma once

#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// One thread: one column of nodes. What the maps keep of it: thickness and arrival.
template <class Real>
struct RecordColumns {
  GridView<Real> grid;
  const int* active;
  const double* mass;
  ColumnDensity<Real> density;
  double time;
  MapView maps;
  TALUS_HD void operator()(int c) const {
    const ActiveColumn at(grid, active, c);
    if (!at.in_domain(grid)) return;
    const BlockSlot slot = grid.slots[at.block];
    double total = 0;
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k)
      total += mass[GridView<Real>::node(slot, at.i, at.j, k)];
    const int column = grid.column(at.i, at.j);
    const double spacing = static_cast<double>(grid.spacing);
    if (total > 0) record_column(maps, column, {total, density.of(column, total), spacing}, time);
  }
};

}  // namespace talus::solver
