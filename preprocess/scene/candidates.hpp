// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which of the regions that lie lower after than before is the slide: reservoirs, quarries, felled forest and molten
// ice lie lower too.
#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "common/map/regions.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/survey/change.hpp"

namespace talus::preprocess {

/// A region of lowering, and what speaks for and against its being a slide.
struct Candidate {
  std::array<double, 2> place{};  ///< its deepest cell, map coordinates [m]
  double volume = 0;              ///< that lies lower [m3]
  double slope = 0;               ///< of the ground before, median [deg]
  double rise = 0;                ///< volume that rose beside it and on the way down from it [m3]
  double drop = 0;                ///< from its highest cell to the cell that rose and lies farthest from it [m]
  double length = 0;              ///< between the two in plan [m]; 0: nothing rose
  double top = 0, foot = 0;       ///< highest and lowest ground before in it [m]
  bool shares = false;            ///< more than twice as much rose as fell: what rose is not its own alone
  std::string doubt = {};         ///< why it may be no slide; "" where nothing speaks against it
};

/// The two surfaces on the working grid, with the lowering as it counts [m] and what changed.
struct Lowered {
  const Raster &before, &after, &lowering;
  const Change& change;
};

/// Measures the largest ten of `regions` (regions_above()) that are no noise, the largest first. What rose is sought
/// as for the deposit (grown_slide()); what fell in larger or level regions is no part of a smaller one. A candidate is
/// doubtful where
/// - it is level before and after (is_level());
/// - less than half, or more than twice, of what fell on its way rose there, or that lies higher (wrong_order());
/// - H/L to what rose is less than slides of its volume hardly ever have (usual_reach()).
std::vector<Candidate> candidates_of(const Lowered& lowered, const std::vector<Region>& regions,
                                     const DepositOptions& how);

/// A candidate as messages name it: "31,200 m3 at [400505.0, 5200205.0], slope 24 degrees, ...".
std::string words_of(const Candidate& candidate);

/// The place of the largest candidate that is not doubtful, where it has no rival: a candidate of a tenth of its volume
/// or more that is not doubtful either, or shares what rose and does not lie wholly below it, as ground does that the
/// slide took along. A warning names those that are larger. Refuses all else as "doubtful-source"; where that is
/// accepted, the place of the largest. `files` as messages call the models.
std::array<double, 2> place_of_slide(const std::vector<Candidate>& candidates, const SurveyFiles& files);

}  // namespace talus::preprocess
