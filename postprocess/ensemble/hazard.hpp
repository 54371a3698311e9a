// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Hazard classes of an ensemble: by how probable it is that a place is hit at least so hard.
#pragma once

#include <optional>
#include <vector>

#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// What a hazard map is made of: the counts by which it goes.
struct HazardRule {
  std::size_t tally = 0;                ///< of counted_maps
  std::vector<std::size_t> thresholds;  ///< places of the intensity limits among those counted
  std::vector<double> intensity;        ///< limits, rising [unit of the map]
  std::vector<double> probability;      ///< lower limits of the classes, rising
  std::vector<int> matrix;              ///< class by intensity (from weak) and probability (from rare), row by row
};

/// The rule of the recipe; empty where it names no limits and the usual ones are not among the counted, and of slides,
/// whose shares are no probabilities. Throws DataError where the recipe names limits that were not counted.
std::optional<HazardRule> hazard_rule(const Ensemble& ensemble, const HazardOptions& options);

/// The largest class that an intensity and its probability give, by place of the counts; 0 where none does.
std::vector<double> hazard_classes(const Ensemble& ensemble, const HazardRule& rule);

/// The matrix as one sentence for metadata: "peak pressure of 3 kPa or more: 1 from 0.01, 1 from 0.1, 2 from 0.5; ...".
std::string hazard_words(const HazardRule& rule);

}  // namespace talus::postprocess
