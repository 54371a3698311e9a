// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// report.html: one self-contained page about a run, for people.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// What one stage left about itself.
struct StageText {
  std::string stage;                ///< "preprocess"
  std::optional<std::string> text;  ///< of its *.used.toml; empty: there is none
};

/// What the report is made from.
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

/// The page as the bytes of an HTML file: nothing in it is loaded from elsewhere. Throws DataError when a *.used.toml
/// or the points of the run cannot be read.
std::string report_html(const ReportInput& input);

}  // namespace talus::postprocess
