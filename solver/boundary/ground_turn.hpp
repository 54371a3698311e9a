// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far the ground turns under a node in half a step: what makes steps over curved ground of second order.
#pragma once

#include "solver/state/grid_view.hpp"

namespace talus {

/// The climb of the ground before a velocity v in half a step of dt [s] over that which its slopes b at node (i, j)
/// give: dt/2 v . grad b . v (T12d) [m/s]. A velocity holds from one step to the next, and the ground that it slides
/// along is the chord between, whose slopes are those half a step ahead. Gradients are central differences of the
/// nodes' slopes.
template <class Real>
TALUS_HD Real climb_ahead(const GridView<Real>& grid, int i, int j, const Vec3<Real>& v, Real dt) {
  const int west = i > 0 ? i - 1 : i, east = i + 1 < grid.columns ? i + 1 : i;
  const int south = j > 0 ? j - 1 : j, north = j + 1 < grid.rows ? j + 1 : j;
  if (west == east || south == north) return Real(0);
  const int w = grid.column(west, j), e = grid.column(east, j), s = grid.column(i, south), n = grid.column(i, north);
  const Real across = Real(1) / (Real(east - west) * grid.spacing),
             along = Real(1) / (Real(north - south) * grid.spacing);
  const Real xx = (grid.slope_x[e] - grid.slope_x[w]) * across, yy = (grid.slope_y[n] - grid.slope_y[s]) * along;
  const Real twice_xy = (grid.slope_y[e] - grid.slope_y[w]) * across + (grid.slope_x[n] - grid.slope_x[s]) * along;
  return dt / Real(2) * (v.x * v.x * xx + v.x * v.y * twice_xy + v.y * v.y * yy);
}

/// The same as a velocity across the bed [m/s]: that of a node which slides along the chord.
template <class Real>
TALUS_HD Real turn_of_ground(const GridView<Real>& grid, int i, int j, const Vec3<Real>& v, Real dt) {
  const int column = grid.column(i, j);
  const Real sx = grid.slope_x[column], sy = grid.slope_y[column];
  return Real(climb_ahead(grid, i, j, v, dt) / sqrt(Real(1) + sx * sx + sy * sy));
}

}  // namespace talus
