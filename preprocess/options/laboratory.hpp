// Laboratory scenes as the recipe gives them: the grid, the sides of the boxes, and what must hold of them.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

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

/// Adds the faults of a laboratory that the ranges of its keys do not show: no spacing, boxes that overlap, reach
/// beyond the grid or are not filled exactly by the lattice of points, and keys that belong to elevation models.
/// Expects grid.points_per_cell to be in order.
void check_laboratory(const Options& options, std::vector<Fault>& faults);

}  // namespace talus::preprocess
