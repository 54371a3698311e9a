// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The ground between the nodes of a Cartesian grid where it is met by points: bicubic through the terrain (Catmull &
// Rom 1974).
#pragma once

#include "solver/state/particles.hpp"

namespace talus {

/// The ground at a point of the map: height above the datum and slopes.
template <class Real>
struct GroundPoint {
  Real height = 0, slope_x = 0, slope_y = 0;  ///< above the datum [m]; [-]
};

/// This function makes the Catmull-Rom weights of the four values about s in [0, 1), and their slopes (Catmull & Rom
/// 1974).
template <class Real>
TALUS_HD void catmull_rom(Real s, Real weight[4], Real slope[4]) {
  const Real s2 = s * s, s3 = s2 * s, half = Real(0.5);
  weight[0] = half * (-s + Real(2) * s2 - s3);
  weight[1] = half * (Real(2) - Real(5) * s2 + Real(3) * s3);
  weight[2] = half * (s + Real(4) * s2 - Real(3) * s3);
  weight[3] = half * (s3 - s2);
  slope[0] = half * (Real(-1) + Real(4) * s - Real(3) * s2);
  slope[1] = half * (Real(-10) * s + Real(9) * s2);
  slope[2] = half * (Real(1) + Real(8) * s - Real(9) * s2);
  slope[3] = half * (Real(-2) * s + Real(3) * s2);
}

/// The terrain at the nodes: elevation [rows * columns] above the datum [m], and the spacing of the nodes [m].
template <class Real>
struct NodeTerrain {
  const Real* elevation = nullptr;
  int columns = 0, rows = 0;
  Real spacing = 0;
};

/// The ground `x`, `y` cells from node (i, j), -1 <= x, y <= 1; its height is in metres above the datum.
template <class Real>
TALUS_HD GroundPoint<Real> bicubic_ground(const NodeTerrain<Real>& terrain, int i, int j, Real x, Real y) {
  const int columns = terrain.columns, rows = terrain.rows;
  if (x < Real(0)) {
    --i;
    x += Real(1);
  }
  if (y < Real(0)) {
    --j;
    y += Real(1);
  }
  Real wx[4], gx[4], wy[4], gy[4];
  catmull_rom(x, wx, gx);
  catmull_rom(y, wy, gy);
  GroundPoint<Real> g;
  for (int b = 0; b < 4; ++b) {
    const int row = j + b - 1 < 0 ? 0 : j + b - 1 < rows ? j + b - 1 : rows - 1;
    Real value = 0, along = 0;
    for (int a = 0; a < 4; ++a) {
      const int column = i + a - 1 < 0 ? 0 : i + a - 1 < columns ? i + a - 1 : columns - 1;
      const Real z = terrain.elevation[row * columns + column];
      value += wx[a] * z;
      along += gx[a] * z;
    }
    g.height += wy[b] * value;
    g.slope_x += wy[b] * along;
    g.slope_y += gy[b] * value;
  }
  g.slope_x = g.slope_x / terrain.spacing;
  g.slope_y = g.slope_y / terrain.spacing;
  return g;
}

/// This function puts a material point that got below ground met by points onto it: contact holds the mean about a
/// point of the ground, and on rough ground single ones slip through. Their velocity is left to the contact, which
/// knows of friction.
template <class Real>
TALUS_HD void keep_above_ground(const GridView<Real>& grid, const ParticleView<Real>& points, int p) {
  const int i = points.cell[0][p], j = points.cell[1][p];
  if (i < 1 || j < 1 || i + 1 >= grid.columns || j + 1 >= grid.rows) return;
  const GroundPoint<Real> ground =
      bicubic_ground(NodeTerrain<Real>{grid.terrain, grid.columns, grid.rows, grid.spacing}, i, j, points.offset[0][p],
                     points.offset[1][p]);
  const Real to = ground.height / grid.layer_height, nearest = Real(floor(to + Real(0.5)));
  if (Real(points.cell[2][p]) - nearest + points.offset[2][p] >= to - nearest) return;
  points.cell[2][p] = static_cast<int>(nearest);
  points.offset[2][p] = to - nearest;
}

}  // namespace talus
