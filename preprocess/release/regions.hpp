// Connected regions of lowering.
#pragma once

#include <cstddef>
#include <vector>

#include "common/raster/raster.hpp"

namespace talus::preprocess {

/// Cells (8-connected) lowered by more than a threshold.
struct Region {
  std::vector<std::size_t> cells;
  double volume = 0;  // [m3]
};

/// All regions, the largest by volume first. `lowering` is in m, NaN counts as none.
std::vector<Region> lowering_regions(const Raster& lowering, double threshold);

/// Noise gives a region a fringe: marked cells (above 0) with fewer than four of their eight neighbours marked become 0.
void cut_fringe(const MapGrid& grid, std::vector<double>& marked);

}  // namespace talus::preprocess
