// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What talus-postprocess writes of a run: maps, picture, tables, page and scores.
#pragma once

#include <filesystem>
#include <optional>

#include "common/run/run_file.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/budget/budget_table.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// What is worked on: a run, and what it is scored against.
struct Job {
  std::filesystem::path file;  ///< run.h5
  Run run;
  Options options;
  std::optional<Survey> survey;
  Thalweg thalweg;
  Hazard hazard;
  std::optional<BudgetTable> budget = {};
};

/// Writes all results of a run into context.out, score.json last; what an older run left of them goes first. Throws
/// DataError.
void write_results(StageContext& context, const Job& job, const Stage& stage);

}  // namespace talus::postprocess
