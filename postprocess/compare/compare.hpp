// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs beside one another, on one page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "common/stage/stage.hpp"

namespace talus::postprocess {

/// A run, and what its stages left beside it.
struct ComparedRun {
  std::string name;  ///< what the page calls it
  Run run;
  std::string score;              ///< the text of score.json
  std::vector<std::string> used;  ///< the texts of *.used.toml
};

/// How far two deposits differ, on the first one's grid.
struct DepositDifference {
  Raster difference;   ///< second less first, vertical [m]; NaN where both are outside
  double larger = 0;   ///< largest gain [m]
  double smaller = 0;  ///< largest loss, as a positive number [m]
  double volume = 0;   ///< of the second less that of the first [m3]
  double moved = 0;    ///< share of the first deposit that lies elsewhere in the second, volumes set equal [-]
  double overlap = 0;  ///< area of both over area of either, where thicker than the threshold [-]
  double rms = 0;      ///< over that area [m]
};

/// Compares the deposits; the second is brought to the first one's grid by area weights, which keep its volume. Throws
/// DataError where the coordinate systems differ.
DepositDifference deposit_difference(const RunMaps& first, const RunMaps& second, double threshold);

/// The map of the difference as a PNG file's bytes: both outlines over a hillshade, gauges and obstacles of both.
std::string difference_map(const Run& first, const Run& second, const DepositDifference& found, double threshold);

/// The page as the bytes of an HTML file: nothing in it is loaded from elsewhere, and no script runs in it.
std::string comparison_html(const ComparedRun& first, const ComparedRun& second, double threshold);

/// What --against does: compares the run in context.out with the one in another folder, and writes
/// context.out/comparison.html. Throws DataError.
void compare(StageContext& context, const std::filesystem::path& other);

}  // namespace talus::postprocess
