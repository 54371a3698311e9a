// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines of what a run touched, left and released, and of the survey, for the GeoPackage beside the maps.
#pragma once

#include <optional>
#include <vector>

#include "common/gis/outlines.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Layers `footprint` (peak thickness above the footprint's threshold), `deposit` (final thickness above the deposit's
/// and above the limits of the classes), `pressure` (peak pressure above 1|3|5|10 kPa and so on), `release` and, where
/// there is one, `survey`.
std::vector<OutlineLayer> map_outlines(const Run& run, const Options& options, const std::optional<Survey>& survey);

}  // namespace talus::postprocess
