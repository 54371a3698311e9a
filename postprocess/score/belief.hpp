// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What may be believed of a run, in three sentences: the same in report.html, score.txt, score.json and map.png.
#pragma once

#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/score.hpp"

namespace talus::postprocess {

/// Where friction and volume come from; how far the run ends from the reference and what the stages warn of (by name;
/// the findings of the score have the words); what the map may not be used for. `score`: of this run, with its
/// findings; `survey`: null where there is none.
std::vector<std::string> belief_of(const Run& run, const Options& options, const Survey* survey, const Score& score);

}  // namespace talus::postprocess
