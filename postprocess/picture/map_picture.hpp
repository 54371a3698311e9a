// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <optional>
#include <string>

#include "common/run/run_file.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/picture/canvas.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// The flow at one time.
struct Instant {
  double time = 0;                       // [s]
  const std::vector<double>& thickness;  // on the run's grid [m]
  double thickest = 0;                   // over all times, for the classes [m]
};

/// What the picture is drawn from.
struct PictureInput {
  const Run& run;
  const Options& options;
  const std::optional<Survey>& survey;
  const Score& score;
  std::optional<Instant> instant{};  ///< show the flow then, and not the deposit
  const Hazard* hazard = nullptr;    ///< its outlines are drawn as well
};

/// The picture of a job, without an instant.
PictureInput picture_of(const Job& job);

/// The map as it is drawn, on 200 dpi.
Canvas draw_map(const PictureInput& input);

/// The deposit map as a PNG file's bytes: hillshade of the surface before the failure, deposit thickness in classes,
/// outlines of release, footprint and survey, contours, coordinates, legend, scale bar, north arrow, key numbers. Made
/// for 200 dpi.
std::string map_picture(const PictureInput& input);

}  // namespace talus::postprocess
