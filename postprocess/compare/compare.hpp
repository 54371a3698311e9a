// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two runs beside one another, on one page.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/score/deposit_difference.hpp"

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

/// What --against does: compares the run in context.out with the one in another folder, and writes
/// context.out/comparison.html. Throws DataError.
void compare(StageContext& context, const std::filesystem::path& other);

/// Lower limits of the sizes that are told apart [m]: 1, 2, 5, 10, 20 and 50 fiftieths of the largest, rounded.
std::vector<double> difference_limits(const DepositDifference& found);

/// A round step of an axis that divides `range` into four to ten parts; `range` above 0.
double axis_step(double range);

/// Charts (SVG, as markup of a page) of what both histories or one of them holds, from all of their records: kinetic
/// energy, largest speed, volume in motion, and what was measured at places. The first run solid, the second dashed.
/// Empty where neither has a history.
std::string history_charts(const ComparedRun& first, const ComparedRun& second);

}  // namespace talus::postprocess
