// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which changed ground belongs to the slide: from the source on, beside it and down the way that a flow takes.
#pragma once

#include <string>
#include <vector>

#include "preprocess/options/options.hpp"
#include "preprocess/regions/regions.hpp"

namespace talus::preprocess {

/// What changed between two surveys, on the working grid.
struct Change {
  Raster rise;                 ///< after less before [m]
  std::vector<double> levels;  ///< from which it is believed: level of detection, and at least threshold_m [m]
  std::vector<double> noise;   ///< the level of detection alone [m]

  /// True where a cell is believed to have changed.
  bool believed(std::size_t cell) const;
  /// True where no noise makes such a change: believed, and beyond `levels` times the level of detection.
  bool stands_out(std::size_t cell, double levels) const;
};

/// Connected regions of believed change, up or down, that are no noise: `sure_cells` of their cells stand out by
/// `sure_levels` (where the level of detection is 0, one). Their fringe is left out (cut_fringe()), but for cells that
/// stand out.
std::vector<Region> sure_regions(const Change& change, const DepositOptions& how);

/// The ground that a slide went over: before it, and what failed.
struct SlideGround {
  const Raster &before, &source;  ///< surface [m]; thickness, 0 outside the source [m]
};

/// The cells of the slide: the source, and regions that lie within `bridge_cells` of it, of one another, or of the way
/// down from them (WayDown). A way ends where its gap, the length over which nothing changed, is longer than
/// `longest_gap` times the distance from the crown to where it began (and longer than the bridge). Ground steeper than
/// `steepest_rest_deg` does not count to it, since nothing stays there. A bridge does not cross ground that stands
/// above both its ends by more than the mean thickness of the source: the next valley is not beside this one.
std::vector<char> grown_slide(const SlideGround& ground, std::vector<Region> regions, const DepositOptions& how);

/// What is believed to have risen and fallen within reach of a slide without belonging to it [m3].
struct Near {
  double rise = 0, fall = 0;
};

/// Of the believed change that `inside` leaves out, the regions that would belong to the slide if they were no noise.
/// They reach no further regions: noise hangs together with noise all over a map.
Near change_near(const SlideGround& ground, const Change& change, const std::vector<char>& inside,
                 const DepositOptions& how);

/// What changed elsewhere than in the slide.
struct ChangeOutside {
  double rise = 0, fall = 0;            ///< of all believed change, a share of which is noise [m3]
  double sure_rise = 0, sure_fall = 0;  ///< of regions that are no noise [m3]
  double largest = 0;                   ///< rise and fall of the largest of them, both positive [m3]
  std::string place;                    ///< a cell of it; "" where there is none

  /// What of the sure change balances no other: what rose without as much that fell, or the other way round [m3].
  double unbalanced() const;
};

/// Sums up what `inside` leaves out.
ChangeOutside change_outside(const Change& change, const std::vector<Region>& sure, const std::vector<char>& inside);

}  // namespace talus::preprocess
