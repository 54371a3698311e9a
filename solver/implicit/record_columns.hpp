// Maps of the end of an implicit step.
#pragma once

#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// One thread: one column of nodes. What the maps keep of it at the end of a step: thickness, speed, pressure.
template <class Real>
struct RecordColumns {
  GridView<Real> grid;
  const int* active;
  const double* mass;
  const Vec3<double>* velocity;  ///< null in statics
  double density;                ///< where all points have the same [kg/m3]
  const double* volumes;         ///< of the matter over each column, where they differ [m3]; else null
  double time;
  MapView maps;
  TALUS_HD void operator()(int c) const {
    const int block = active[c / block_columns], inside = c % block_columns;
    const int i = (block % grid.block_columns_x) * block_side + (inside & 3);
    const int j = (block / grid.block_columns_x) * block_side + (inside >> 2);
    if (i >= grid.columns || j >= grid.rows) return;
    const BlockSlot slot = grid.slots[block];
    double total = 0;
    Vec3<double> momentum{};
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
      const int n = GridView<Real>::node(slot, i, j, k);
      total += mass[n];
      if (velocity && mass[n] > 0) momentum += velocity[n] * mass[n];
    }
    const double spacing = static_cast<double>(grid.spacing);
    const int column = grid.column(i, j);
    const double mean = volumes && volumes[column] > 0 ? total / volumes[column] : density;
    if (total > 0) record_column(maps, column, {total, length(momentum), mean, spacing}, time);
  }
};

}  // namespace talus::solver
