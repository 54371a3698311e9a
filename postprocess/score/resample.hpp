// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The scores that other surveys, as likely as the one at hand, would have given.
#pragma once

#include <vector>

#include "common/map/raster.hpp"
#include "postprocess/score/sections.hpp"

namespace talus::postprocess {

/// Scores of surveys drawn within their error, a value each draw. Empty vectors: not asked for, or no error is known.
struct Resampled {
  std::vector<double> footprint_csi;  ///< empty unless the footprint is a surveyed change
  std::vector<double> deposit_csi, rmse, bias, volume, volume_ratio, runout_difference, thalweg_runout_difference;
};

/// Each draw is measured + sigma g with g from RandomField, brought under the level of detection again, and scored as
/// the survey is. Cells measured as exactly 0 were mapped as untouched and stay so. For the run-out only patches of
/// deposit count that touch a deposit of the survey: noise far away is no run-out. The survey holds one such error
/// already, so the mean of the draws lies a little below a score that errors can only lower.
Resampled resample(const Scored& scored, const OnSurveyGrid& simulated);

/// `values` without the patches (cells above `threshold`, joined by eight neighbours) that hold no cell of `seeds`:
/// such cells become 0.
std::vector<double> patches_with(const MapGrid& grid, const std::vector<double>& values, double threshold,
                                 const std::vector<char>& seeds);

}  // namespace talus::postprocess
