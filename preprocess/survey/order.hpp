// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which survey came first, by where mass went.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/error.hpp"
#include "preprocess/survey/slide_growth.hpp"

namespace talus::preprocess {

/// What rose and what fell, and how high that lies on average, weighed by volume.
struct Order {
  double rise = 0, fall = 0;                // [m3]
  double rise_height = 0, fall_height = 0;  // [m]
};

/// Of the cells of regions that are no noise; heights are those halfway between both surveys.
Order order_of(const Change& change, const std::vector<Region>& sure, const Raster& before);

/// The two files as messages call them.
struct SurveyFiles {
  std::string before, after;
  bool aligned = false;  ///< the later one was moved onto the earlier
};

/// The fault "swapped-surveys" where mass would have gone uphill (what rose lies higher than what fell, and is more
/// than a tenth of it) or would have come from nowhere (more than twice as much rose as fell); empty where neither is
/// so.
std::optional<Fault> wrong_order(const Order& order, const SurveyFiles& files);

/// Refuses that, unless it is accepted.
void judge_order(const Order& order, const SurveyFiles& files);

}  // namespace talus::preprocess
