// Connected regions of lowering.
#pragma once

#include <cstddef>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::preprocess {

/// Cells (8-connected) lowered by more than a threshold.
struct Region {
  std::vector<std::size_t> cells;
  double volume = 0;  // [m3]
};

/// All regions, the largest by volume first. `lowering` is in m, NaN counts as none.
std::vector<Region> lowering_regions(const Raster& lowering, double threshold);

/// Marked cells (above 0) among a cell and its neighbours, up to eight, and how many of those the map has.
struct Company {
  int marked = 0, cells = 0;
};
Company company_of(const MapGrid& grid, const std::vector<double>& marks, int column, int row);

/// Noise gives a region a fringe: marked cells (above 0) with fewer than four of their eight neighbours marked become
/// 0.
void cut_fringe(const MapGrid& grid, std::vector<double>& marked);

}  // namespace talus::preprocess
