// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What every result of an ensemble says of the ensemble.
#pragma once

#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/ensemble/maps_of_ensemble.hpp"

namespace talus::postprocess {

/// The refusals that the recipe overrides, in the stages before and in this one: of members the first of each name.
std::vector<Finding> insisted_on(const Ensemble& ensemble);

/// Title, scene, design, seed and numbers of members: name (in capitals) and words.
Facts ensemble_facts(const Ensemble& ensemble);

/// What a map says of itself besides: threshold, unit, meaning of its share and of its error.
Facts map_facts(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard);

}  // namespace talus::postprocess
