// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a stage has to run again.
#pragma once

#include <string>

#include "common/recipe/recipe.hpp"
#include "talus/request.hpp"

namespace talus::command {

/// A stage, and what its results are judged by.
struct StageState {
  std::string stage;      ///< "solve"
  Dependencies depends;   ///< what it reads and writes
  std::string own_table;  ///< its part of the recipe, as --used prints it
};

struct Verdict {
  std::string run_because;  ///< why the stage runs; empty: its results are up to date
  std::string remark = {};  ///< what is to be said where they are
};

/// The rule of pipelines/stages.mk: a stage runs where a result is missing, where its own part of the recipe is not the
/// one it was made with (noted in OUT/.inputs/STAGE.toml, and its checksum in the result), and where a file that it
/// reads, or its program, is newer than its result. Beyond that rule: what nobody noted is judged by the checksums
/// alone, so that results which the stages made without talus or make count; an input that is not there counts as
/// unchanged where the result is of this very recipe, and is said.
Verdict judge(const Request& request, const recipe::Recipe& recipe, const StageState& state);

/// Notes with which part of the recipe a stage runs now; pipelines/run-scene reads and writes the same notes.
void note(const Request& request, const StageState& state);

}  // namespace talus::command
