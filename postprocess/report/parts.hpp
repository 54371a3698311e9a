// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the report's data, each a function of the input; report.cpp puts them together.
#pragma once

#include <nlohmann/json.hpp>
#include <vector>

#include "postprocess/fields/window.hpp"
#include "postprocess/report/report.hpp"

namespace talus::postprocess {

using Json = nlohmann::ordered_json;

/// What the page's map shows: the affected window, as wide as it is high where the map goes on that far, since screens
/// are wide.
Window shown_window(const ReportInput& input);

/// Grids to be shown on the map, with their classes: deposit, peaks, arrival, release, survey, difference, agreement.
/// `coarsened` is left as the largest number of cells made one along a side.
Json layers_json(const ReportInput& input, const Window& window, int& coarsest);

/// Thickness over time on the map, and its classes.
Json frames_json(const ReportInput& input, const Window& window, int& coarsest);

/// Elevation before the failure, and its hillshade.
Json ground_json(const ReportInput& input, const Window& window, int& coarsest);

/// Outlines, contours and the thalweg as lists of x, y [m from the window's west and south].
Json lines_json(const ReportInput& input, const Window& window);

/// Elevations, thickness and speed along the thalweg.
Json profile_json(const ReportInput& input);

/// Numbers over time: the history's columns, which of them belong to a place and what they measure there, the front
/// along the thalweg, the volume in motion.
Json series_json(const ReportInput& input);

/// What came to each building.
Json hazard_json(const ReportInput& input);
/// Gauges and obstacles: name, kind, rings [m from the window's west and south] and the largest of what was measured.
Json places_json(const ReportInput& input);

/// The sections and entries of a score, and what was not scored.
Json score_json(const Score& score);

/// Release and deposit read both ways, vertical and normal to the slope, with projected and true area.
Json volumes_json(const Run& run, double deposit_threshold);

/// What each stage used: facts, keys, defaults.
Json stages_json(const std::vector<StageText>& stages);

/// Rising positive limits of a symmetric scale [m]: 1/5, 1/2 and the whole of a round number that nine in ten
/// differences do not exceed. NaN and 0 are left out.
std::vector<double> difference_limits(const std::vector<double>& differences);

}  // namespace talus::postprocess
