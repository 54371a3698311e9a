// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The shape of a grid and the terrain below it, on the host.
#pragma once

#include <cstddef>
#include <vector>

#include "solver/state/grid_view.hpp"

namespace talus {

/// The numbers that the grid is made of, on the host.
struct GridShape {
  int columns = 0, rows = 0;
  double spacing = 0, layer_height = 0;  ///< [m]
  Mapping mapping = Mapping::terrain_following;
  bool quadratic = true;
  double lowest_weighed = 0;    ///< see GridView
  std::vector<double> terrain;  ///< elevations at the nodes [m], NaN outside the domain; [rows * columns]

  /// The place of node (i, j) in arrays [rows * columns]: row by row, the southernmost first, as MapGrid::index().
  std::size_t index(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(i);
  }
};

/// The terrain as kernels use it: coefficients, slopes at the nodes, where points may be; each [rows * columns].
struct TerrainTables {
  double datum = 0;  ///< lowest elevation [m]; heights below are from here
  std::vector<double> terrain, slope_x, slope_y;
  std::vector<unsigned char> open;
};

/// The terrain of a grid: elevations at the nodes above the datum, the coefficients b_i of (T1), and the slopes there.
TerrainTables make_terrain_tables(const GridShape& shape);

/// The elevation of the terrain at (xi, eta), in cells from node (0, 0), by the grid's functions (T1) [m above datum].
double terrain_at(const GridShape& shape, const TerrainTables& tables, double xi, double eta);

}  // namespace talus
