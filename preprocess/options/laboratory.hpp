// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laboratory scenes as the recipe gives them: the grid, the boxes, their sides, and what must hold of them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

struct GridOptions;
struct Options;

/// The keys of [preprocess.laboratory]: a level or tilted plane without elevation models, in cells of grid.spacing_m.
struct LaboratoryOptions {
  int columns = 0, rows = 0;   ///< 0: no laboratory
  double west = 0, south = 0;  ///< [m]
  double ground = 0;           ///< elevation of the south-western corner [m]
  double slope_x = 0, slope_y = 0;

  bool given() const { return columns > 0 || rows > 0; }
  bool has_cells() const { return columns > 0 && rows > 0; }
  void describe(recipe::Visitor& v, const Options& all);
};

/// One [[preprocess.box]]: a block of material; heights count from the ground.
struct BoxOptions {
  std::string name;
  double west = 0, east = 0, south = 0, north = 0, bottom = 0, top = 0;  ///< [m]
  std::optional<double> top_east = {};  ///< the top there, where it is not level: a slope [m]

  /// The height of the top over a place between west and east [m].
  double top_at(double x) const { return top + (top_east.value_or(top) - top) * (x - west) / (east - west); }
  void describe(recipe::Visitor& v);
};

/// A side of a box: from where to where it reaches along x, y or height, and the keys of the recipe that say so.
struct BoxSide {
  const char *low_key, *high_key;
  double low, high;  // [m]
  /// Extent of the side [m].
  double length() const { return high - low; }
};

/// The sides of a box along x, y and height above the ground.
std::array<BoxSide, 3> sides_of(const BoxOptions& box);

/// The name of a box, or "box-N" for the N-th where it has none (`item` counts from 0).
std::string box_name(const BoxOptions& box, std::size_t item);

/// Distance between the points of a box along x, y and height [m].
std::array<double, 3> point_spacing(const GridOptions& grid);

/// The grid of a laboratory, in local coordinates.
MapGrid laboratory_grid(const Options& options);

/// This function adds the faults of boxes that their keys do not show: boxes of one name, boxes that reach beyond the
/// grid or are not filled exactly by the lattice of points, and, where `faults` is empty by then, boxes that overlap.
/// It expects a laboratory with cells and a grid that stands alone.
void check_boxes(const Options& options, std::vector<Fault>& faults);

}  // namespace talus::preprocess
