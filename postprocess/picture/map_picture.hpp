#pragma once

#include <optional>
#include <string>

#include "common/run/run_file.hpp"
#include "postprocess/options.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/score/survey.hpp"

namespace talus::postprocess {

struct PictureInput {
  const Run& run;
  const Options& options;
  const std::optional<Survey>& survey;
  const Score& score;
};

/// The deposit map as a PNG file's bytes: hillshade of the surface before the failure, deposit thickness in classes,
/// outlines of release, footprint and survey, contours, coordinates, legend, scale bar, north arrow, key numbers. Made
/// for 200 dpi.
std::string map_picture(const PictureInput& input);

}  // namespace talus::postprocess
