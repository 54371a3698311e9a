// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What changed between two surveys: which of it belongs to the slide (from the source on, beside it and down the way
// that a flow takes), and which survey came first.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "common/map/regions.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/options/options.hpp"

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
/// `sure_levels` (where the level of detection is 0, one). Fringes that do not stand out are cut (cut_fringe()).
std::vector<Region> sure_regions(const Change& change, const DepositOptions& how);

/// The cells of the slide on the surface `before` [m]: the source, where its thickness is above 0, and regions that lie
/// within `bridge_cells` of it, of one another, or of the way down from them (WayDown). A way ends where its gap, the
/// length over which nothing changed, is longer than `longest_gap` times the distance from the crown to where it began
/// (and longer than the bridge). Ground steeper than `steepest_rest_deg` does not count to it, since nothing stays
/// there. A bridge does not cross ground that stands above both its ends by more than the mean thickness of the source:
/// the next valley is not beside this one.
std::vector<char> grown_slide(const Raster& before, const Raster& source, std::vector<Region> regions,
                              const DepositOptions& how);

/// What is believed to have risen and fallen within reach of a slide without belonging to it [m3].
struct Near {
  double rise = 0, fall = 0;
};

/// Of the believed change that `inside` leaves out, the regions that would belong to the slide if they were no noise.
/// They reach no further regions: noise hangs together with noise all over a map.
Near change_near(const Raster& before, const Raster& source, const Change& change, const std::vector<char>& inside,
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

/// What rose and what fell, and how high that lies on average, weighed by volume.
struct Order {
  double rise = 0, fall = 0;                // [m3]
  double rise_height = 0, fall_height = 0;  // [m]
};

/// The order of single cells, summed up; heights are those halfway between both surveys.
class OrderSum {
 public:
  /// Adds a cell that rose (or fell, below 0) by `rise` from a height `before` [m].
  void add(double rise, double before);
  /// The order of all cells added, each `cell` wide [m].
  Order order(double cell) const;

 private:
  std::array<Sum, 2> volume_, moment_;  // of what fell, of what rose
};

/// Of the cells of regions that are no noise.
Order order_of(const Change& change, const std::vector<Region>& sure, const Raster& before);

/// The two files as messages call them.
struct SurveyFiles {
  std::string before, after;
  bool aligned = false;  ///< the later one was moved onto the earlier
};

constexpr double swells = 2.0;  ///< what fell loosens by 1.2 to 1.5; more than twice as much has come from elsewhere

/// The fault "swapped-surveys" where mass would have gone uphill (what rose lies higher than what fell, and is more
/// than a tenth of it) or would have come from nowhere (more than twice as much rose as fell).
std::optional<Fault> wrong_order(const Order& order, const SurveyFiles& files);

/// Refuses that, unless it is accepted.
void judge_order(const Order& order, const SurveyFiles& files);

}  // namespace talus::preprocess
