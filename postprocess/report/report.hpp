// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// report.html: one self-contained page about a run, for people, and the parts of its data.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/report/page.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// What one stage left about itself.
struct StageText {
  std::string stage;                ///< "preprocess"
  std::optional<std::string> text;  ///< of its *.used.toml; empty: there is none
};

struct ReportInput {
  const Run& run;
  const Options& options;
  const std::optional<Survey>& survey;
  const Score& score;
  const Thalweg& thalweg;
  std::vector<StageText> stages;
  std::optional<std::string> comparison;  ///< survey.json of talus-preprocess; empty: no two models were compared
  std::filesystem::path run_file;         ///< for what is read of the points: how much is in motion
  const Hazard* hazard = nullptr;
};

/// The page as HTML that loads nothing from elsewhere. Throws DataError where a *.used.toml or points cannot be read.
std::string report_html(const ReportInput& input);

/// What the page's map shows.
Window shown_window(const ReportInput& input);

/// Grids to be shown on the map, with their classes. `coarsest`: the largest number of cells made one along a side.
Json layers_json(const ReportInput& input, const Window& window, int& coarsest);

/// Thickness over time on the map, and its classes.
Json frames_json(const ReportInput& input, const Window& window, int& coarsest);

/// Elevation before the failure.
Raster shown_ground(const ReportInput& input, const Window& window, int& coarsest);

/// Outlines, contours and the thalweg as lists of x, y [m from the window's west and south].
Json lines_json(const ReportInput& input, const Window& window);

/// Elevations, thickness and speed along the thalweg.
Json profile_json(const ReportInput& input);

/// Numbers over time: the history, what its columns measure at places, the front along the thalweg, volume in motion.
Json series_json(const ReportInput& input);

/// Gauges and obstacles: name, kind, rings [m from the window's west and south] and the largest of what was measured.
Json places_json(const ReportInput& input);

/// Release and deposit read both ways, vertical and normal to the slope, with projected and true area.
Json volumes_json(const Run& run, double deposit_threshold);

/// What each stage used: facts, keys, defaults.
Json stages_json(const std::vector<StageText>& stages);

/// Rising positive limits of a symmetric scale [m]: 1/5, 1/2 and the whole of a round number that nine in ten
/// differences do not exceed. NaN and 0 are left out.
std::vector<double> difference_limits(const std::vector<double>& differences);

}  // namespace talus::postprocess
