// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs beside one another, on one page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/score/contingency.hpp"

namespace talus::postprocess {

/// A run, and what its stages left beside it.
struct ComparedRun {
  std::string name;  ///< what the page calls it
  Run run;
  std::string score;              ///< the text of score.json
  std::vector<std::string> used;  ///< the texts of *.used.toml
};

/// The map of the difference as a PNG file's bytes: both outlines over a hillshade, gauges and obstacles of both.
std::string difference_map(const Run& first, const Run& second, const DepositDifference& found, double threshold);

/// The page as the bytes of an HTML file: nothing in it is loaded from elsewhere, and no script runs in it.
std::string comparison_html(const ComparedRun& first, const ComparedRun& second, double threshold);

/// What --against does: writes OUT/comparison.html of the run there and the one in another folder. Throws DataError.
void compare(StageContext& context, const std::filesystem::path& other);

/// Lower limits of the sizes that are told apart [m]: 1, 2, 5, 10, 20 and 50 fiftieths of the largest, rounded.
std::vector<double> difference_limits(const DepositDifference& found);

/// A round step of an axis that divides `range` into four to ten parts; `range` above 0.
double axis_step(double range);

/// Charts (SVG, as markup of a page) of what the histories hold: energy, largest speed, motion, measurements at places.
/// The first run solid, the second dashed. Empty where neither has a history.
std::string history_charts(const ComparedRun& first, const ComparedRun& second);

}  // namespace talus::postprocess
