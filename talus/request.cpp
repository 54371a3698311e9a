// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/request.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>

#include "common/error.hpp"
#include "talus/make_rules.hpp"

namespace talus::command {
namespace {

std::vector<std::string> words(const Request& request, const std::filesystem::path& out) {
  std::vector<std::string> words{request.recipe.string()};
  if (!out.empty()) words.insert(words.end(), {"--out", out.string()});
  for (const std::string& value : request.set) words.insert(words.end(), {"--set", value});
  if (request.network) words.emplace_back("--network");
  return words;
}

/// Ctrl-C reaches a stage that answers as well, and is no fault of the recipe.
void stop_if_ended_by_signal(const Outcome& outcome) {
  constexpr int first_signal = 128;
  if (outcome.code > first_signal) throw Interrupted({"stopped", "interrupted", "Start it again"});
}

/// The faults of a stage that would not answer, as they stand on its stderr.
void add_faults(const Outcome& outcome, std::vector<Fault>& faults) {
  for (std::string& line : lines_said(outcome.err)) {
    const auto known = [&](const Fault& fault) { return fault.what == line; };
    if (std::none_of(faults.begin(), faults.end(), known)) faults.push_back({std::move(line), "", ""});
  }
  if (faults.empty())
    faults.push_back({"a stage ended without a word, with exit code " + std::to_string(outcome.code), "", ""});
}

}  // namespace

std::vector<std::string> lines_said(const std::string& text) {
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    at = end + 1;
    for (const char* stage : stage_names)
      if (const std::string name = fmt::format("talus-{}: ", stage); line.starts_with(name)) line.erase(0, name.size());
    if (!line.empty() && std::find(lines.begin(), lines.end(), line) == lines.end()) lines.push_back(std::move(line));
  }
  return lines;
}

Outcome ask(const Request& request, const std::string& stage, const std::string& question) {
  std::vector<std::string> arguments = words(request, request.out);
  arguments.push_back(question);
  return run_program(program_of(stage), arguments, Keep::everything);
}

Outcome run_stage_program(const Request& request, const std::string& stage, const std::vector<std::string>& more,
                          Keep keep) {
  std::vector<std::string> arguments = words(request, request.shown);
  if (request.threads > 0) arguments.insert(arguments.end(), {"--threads", std::to_string(request.threads)});
  if (request.verbose) arguments.emplace_back("-v");
  if (request.quiet) arguments.emplace_back("-q");
  if (stage == "solve") arguments.insert(arguments.end(), {"--on", request.on});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_program(program_of(stage), arguments, keep);
}

std::vector<std::string> used_tables(const Request& request) {
  std::vector<std::string> tables;
  std::vector<Fault> faults;
  for (const char* stage : stage_names) {
    Outcome outcome = ask(request, stage, "--used");
    stop_if_ended_by_signal(outcome);
    if (outcome.code != 0) add_faults(outcome, faults);
    tables.push_back(std::move(outcome.out));
  }
  if (!faults.empty()) throw RecipeError(std::move(faults));
  return tables;
}

Dependencies depends_of(const Request& request, const std::string& stage) {
  const Outcome outcome = ask(request, stage, "--depends");
  if (outcome.code == 0) return read_make_rules(outcome.out);
  stop_if_ended_by_signal(outcome);
  std::vector<Fault> faults;
  add_faults(outcome, faults);
  throw RecipeError(std::move(faults));
}

}  // namespace talus::command
