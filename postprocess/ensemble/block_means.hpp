// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A surveyed map as some hundred means over blocks of cells, with the covariance of their errors.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::postprocess {

/// Square blocks of cells over a mass. What lies beyond them is one number more: its volume, spread over the blocks.
class BlockMeans {
 public:
  /// Blocks of a side that gives the mass about 50 of them, and at least `least_side` [m]. `surveyed` [cells]: NaN
  /// where nothing was; `inside` [cells]: the mass, which exceeds `least`. Blocks of which less than half was surveyed
  /// are left out.
  BlockMeans(const MapGrid& grid, const std::vector<double>& surveyed, const std::vector<char>& inside,
             double least_side, double least);

  std::size_t count() const { return places_.size(); }  ///< the number of blocks
  double side() const { return side_ * cell_; }         ///< of a block [m]
  double extent() const { return extent_; }             ///< the longest distance of two blocks, at least a side [m]
  /// Centres [m]; of what lies beyond a place that is far from all of them.
  std::vector<std::array<double, 2>> places() const;

  /// The mean of each block's surveyed cells, then the sum of what is positive beyond, and farther than a block from
  /// them of what exceeds `least`, over the number of cells in blocks. NaN counts as 0.
  std::vector<double> of(const std::vector<double>& values) const;

  /// The sum of values beyond blocks but no farther than one, over the number of cells in blocks: what noise and a thin
  /// fringe keep out of the mass.
  double volume_beside(const std::vector<double>& values) const;

  /// The covariance [(count + 1)^2] of means of errors with these deviations [cells], alike within `range` by a
  /// spherical correlation, 0: each cell for itself. Its mean over 4 x 4 places in each of two blocks.
  std::vector<double> covariance(const std::vector<double>& deviation, double range) const;

 private:
  static constexpr int out = -1, beyond = -2, beside = -3;  ///< beside: beyond, by a block
  double all_cells() const;
  double cell_, least_;
  int side_ = 1;                  ///< [cells]
  std::vector<int> block_of_;     ///< [cells]
  std::vector<double> cells_in_;  ///< [count] surveyed cells
  std::vector<std::array<double, 2>> places_;
  double extent_ = 0;
};

}  // namespace talus::postprocess
