// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/request.hpp"

#include <algorithm>

#include "postprocess/stage.hpp"
#include "preprocess/stage.hpp"
#include "solver/stage.hpp"

namespace talus::command {

Stage stage_called(const std::string& name) {
  if (name == "preprocess") return preprocess::stage();
  return name == "solve" ? solver::stage() : postprocess::stage();
}

StageCall call_of(const Request& request, const std::string& stage) {
  StageCall call{.recipe = request.recipe, .out = request.shown, .set = request.set};
  if (stage == "solve") call.flags.emplace_back("--on", request.on);
  return call;
}

Dependencies depends_of(const Request& request, const std::string& stage) {
  const Stage program = stage_called(stage);
  return program.depends(open_call(program, call_of(request, stage)));
}

Said call_quietly(const std::string& stage, const StageCall& call) {
  Said said;
  const RedirectLog log([&](LogLevel level, const std::string& text) {
    if (level == LogLevel::advice || level == LogLevel::warning) said.lines.emplace_back(level, text);
  });
  said.outcome = call_stage(stage_called(stage), call);
  return said;
}

void add_table_faults(const Request& request, const std::string& stage, std::vector<Fault>& known) {
  const Stage program = stage_called(stage);
  try {
    program.used_toml(open_call(program, call_of(request, stage)).recipe);
  } catch (const RecipeError& error) {
    for (const Fault& fault : error.faults()) {
      const auto same = [&](const Fault& other) { return to_string(other) == to_string(fault); };
      if (std::none_of(known.begin(), known.end(), same)) known.push_back(fault);
    }
  }
}

void require_tables(const Request& request) {
  std::vector<Fault> faults;
  for (const char* stage : stage_names) add_table_faults(request, stage, faults);
  if (!faults.empty()) throw RecipeError(std::move(faults));
}

}  // namespace talus::command
