// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a score, in their order.
#pragma once

#include <optional>

#include "common/run/mobility.hpp"
#include "postprocess/score/sheet.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// What is scored, and what is measured from.
struct Scored {
  const Run& run;
  const Options& options;
  const Survey* survey;  ///< null: none
  const Thalweg& thalweg;
  std::optional<Place> crown;
  double crown_along = 0;  ///< where the crown lies along the thalweg [m]; NaN without one
};

/// Run-outs from the crown [m]; NaN where there is none.
struct Reach {
  double straight = 0;  ///< to the cell above the threshold that is farthest as the crow flies
  double along = 0;     ///< along the thalweg, to the cell that is farthest along it
};
/// Run-outs from the crown to cells of `values` above `threshold`.
Reach reach_of(const Scored& scored, const MapGrid& grid, const std::vector<double>& values, double threshold);

void add_run(const Scored& scored, Sheet& sheet);       ///< volumes, computation, extent
void add_mobility(const Scored& scored, Sheet& sheet);  ///< run-out, drop, angles, travel
void add_hazard(const Hazard& hazard, Sheet& sheet);    ///< intensity, angle of reach, buildings
/// Overlap, thickness and run-out against the survey, and what that means in units of the survey's error.
void add_agreement(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet);
/// Adds how far the scores vary within the error of the survey.
void add_spread(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet);
/// Adds what the words of a score mean.
void add_definitions(const Scored& scored, Sheet& sheet);

}  // namespace talus::postprocess
