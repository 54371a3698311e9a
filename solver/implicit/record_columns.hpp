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
    const ActiveColumn at(grid, active, c);
    if (!at.in_domain(grid)) return;
    const BlockSlot slot = grid.slots[at.block];
    double total = 0;
    Vec3<double> momentum{};
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k) {
      const int n = GridView<Real>::node(slot, at.i, at.j, k);
      total += mass[n];
      if (velocity && mass[n] > 0) momentum += velocity[n] * mass[n];
    }
    const double spacing = static_cast<double>(grid.spacing);
    const int column = grid.column(at.i, at.j);
    const double mean = volumes && volumes[column] > 0 ? total / volumes[column] : density;
    if (total > 0) record_column(maps, column, {total, length(momentum), mean, spacing}, time);
  }
};

}  // namespace talus::solver
