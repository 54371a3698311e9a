// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Holes in elevation models filled from their rims, with what the filling is worth; cells that stand out.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::preprocess {

/// A void: cells without elevation that hang together (8-connected) and do not reach the edge of the raster.
struct VoidFill {
  std::size_t cells = 0;
  double x = 0, y = 0;          // a cell of it: the one farthest from data, where it was filled [m]
  double area_m2 = 0;           // [m2]
  double largest_distance = 0;  // from a cell's centre to the nearest with data [m]; 0 where it was not filled
  double rmse = 0;      // of filling holes of this shape nearby, where the truth is known [m]; NaN = no place for one
  int trials = 0;       // how many such holes
  bool filled = false;  // false: larger than allowed
};

/// A surface with its voids filled, and how well.
struct Filled {
  Raster raster;
  std::vector<char> filled;   // 1 where a value was made [rows * columns]
  std::vector<double> sigma;  // its standard error [m], 0 where nothing was filled, NaN where it is not known
  std::vector<VoidFill> voids;

  std::size_t count() const;  ///< filled cells
  double rmse() const;        ///< over the filled cells of all voids that have one; NaN for none [m]
};

/// Fills voids up to `largest_m2` by natural neighbours (Sibson 1981) of the cells around, their gradients taken in
/// (CGAL's quadratic interpolation), so that planes and quadratic surfaces are kept. The error is measured: up to eight
/// holes of the same shape beside the void are filled and compared; within a void it grows as the distance to data.
/// Larger voids, and those that reach the edge, stay.
Filled fill_voids(Raster raster, double largest_m2);

/// "3 voids, 120 cells, filled (largest 80 cells, 4.2 cells from data; error 0.31 m)"; "" where nothing was filled.
std::string summary(const Filled& filled);

struct Outlier {
  std::size_t cell = 0;
  double height = 0;  // above the median of its neighbours [m]; negative = a pit
};

/// Cells that lie further from the median of their eight neighbours than ten times what is usual around (the NMAD of
/// such deviations within seven cells), than three times all but one of the neighbours do from theirs (summits and
/// crests are no faults), and at least `minimum_m` and a quarter of a cell. The farthest out first; none on the edge.
std::vector<Outlier> spikes_and_pits(const Raster& raster, double minimum_m = 2.0);

/// "2 spikes and 1 pit: 35.2 m at x 361265.6, y 71238.4; ..."; "" for none.
std::string summary(const std::vector<Outlier>& outliers, const MapGrid& grid);

}  // namespace talus::preprocess
