// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <ios>
#include <new>
#include <optional>
#include <system_error>

#include "common/recipe/shown_paths.hpp"
#include "common/stage/command_line.hpp"
#include "common/stage/console.hpp"
#include "common/stage/context.hpp"
#include "common/stage/crash_report.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/interrupt.hpp"
#include "common/stage/output_lock.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

[[noreturn]] void refuse_output_folder(const fs::path& folder, const std::string& reason) {
  throw DataError(
      {folder.string() + ": the output folder cannot be written to", reason, "Name another one with --out DIR"});
}

/// --check writes nothing, so it asks for the permissions of the nearest folder that is there.
void check_output_folder(const fs::path& folder) {
  fs::path nearest = folder;
  while (!fs::exists(nearest) && nearest.has_relative_path()) nearest = nearest.parent_path();
  errno = fs::is_directory(nearest) ? 0 : ENOTDIR;
  if (errno != 0 || ::access(nearest.c_str(), W_OK | X_OK) != 0)
    refuse_output_folder(folder, std::generic_category().message(errno));
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse_output_folder(folder, error.message());
}

/// The flag of a stage by its name; null where it has none of it (--on of a stage without kernels).
const Flag* flag_called(const Stage& stage, const std::string& name) {
  const auto found =
      std::find_if(stage.flags.begin(), stage.flags.end(), [&](const Flag& f) { return f.name == name; });
  return found == stage.flags.end() ? nullptr : &*found;
}

bool writes_nothing(const Stage& stage, const StageCall& call) {
  return call.check_only || std::any_of(call.flags.begin(), call.flags.end(), [&](const auto& given) {
           const Flag* flag = flag_called(stage, given.first);
           return flag != nullptr && flag->writes_nothing;
         });
}

/// The call as a command line.
std::string command_of(const Stage& stage, const StageCall& call) {
  std::vector<std::string> words{stage.name, call.recipe.string()};
  if (!call.out.empty()) words.insert(words.end(), {"--out", call.out.string()});
  for (const std::string& value : call.set) words.insert(words.end(), {"--set", value});
  if (call.check_only) words.emplace_back("--check");
  if (call.if_outdated) words.emplace_back("--if-outdated");
  for (const auto& [name, value] : call.flags) {
    words.push_back(name);
    if (!value.empty()) words.push_back(value);
  }
  return command_text(words);
}

/// What the results are going to be made of. A fault of recipe or inputs is left to the stage, which knows more of it.
Ingredients ingredients_before(const Stage& stage, const StageContext& context) {
  if (!stage.depends || !stage.used_toml) return {};
  try {
    return ingredients_of(stage, context);
  } catch (const Error&) {
    return {};
  }
}

bool has_made_results(const Stage& stage, const StageContext& context) {
  if (context.made_of.tables.empty()) return false;
  const fs::path last = stage.depends(context).results.front();
  return std::find(context.results.begin(), context.results.end(), last) != context.results.end();
}

/// The results, where they are up to date; says why where they are not.
std::optional<std::vector<fs::path>> fresh_results(const Stage& stage, const StageContext& context) {
  Verdict verdict = judge_freshness(stage, context);
  if (!verdict.run_because.empty()) {
    log_info(fmt::format("{}: {}", stage.table, verdict.run_because));
    return std::nullopt;
  }
  const std::string result = verdict.results.front().filename().string();
  log_info(fmt::format("{}: {} is up to date", stage.table, result));
  if (!verdict.remark.empty()) warn("stale-remark", verdict.remark);
  return std::move(verdict.results);
}

std::vector<fs::path> carry_out(const Stage& stage, const StageCall& call) {
  StageContext opened = open_call(stage, call);
  Findings found(stage.table);
  if (signals_are_watched()) name_for_interrupts(stage.name);
  if (writes_nothing(stage, call)) {
    check_output_folder(opened.out);
    found.settled([&] { stage.run(opened); });
    return opened.results;
  }
  make_output_folder(opened.out);
  std::optional<OutputLock> lock;  // shows besides that the folder takes anything, before long work begins
  if (!opened.part.empty() || !context().has_locked(opened.out)) lock.emplace(opened.out, stage.name, opened.part);
  if (call.if_outdated)
    if (auto results = fresh_results(stage, opened)) return *results;
  opened.made_of = ingredients_before(stage, opened);
  found.settled([&] { stage.run(opened); });
  if (has_made_results(stage, opened)) note_results(stage, opened);
  return opened.results;
}

void print_template(const Stage& stage) {
  fmt::print(
      "# {} {}, written by --template: every key with its default.\n"
      "# A recipe holds [scene] and the tables of all stages:\n"
      "# [scene]\n# name = \"my-scene\"\n# title = \"What the map is called\"\n\n{}",
      stage.name, version(), stage.template_toml());
}

/// What a command line asks for, in the calling thread's context.
StageOutcome run_words(int argc, char** argv, const Stage& stage) {
  auto parsed = parse_command_line(argc, argv, stage);
  if (const auto* answer = std::get_if<Answer>(&parsed)) return fmt::print("{}", answer->text), StageOutcome{};
  auto& line = std::get<CommandLine>(parsed);
  context().verbosity = line.verbosity;
  context().threads = line.threads;
  context().network = line.network;
  if (line.print_template) return print_template(stage), StageOutcome{};
  if (line.call.recipe.empty()) throw RecipeError(Fault{"no recipe was given", "", usage(stage)});
  line.call.command = command_text({argv, argv + argc});
  watch_for_interrupts(stage.name);
  return call_stage(stage, line.call);
}

StageOutcome outcome_of_error(const Error& error) { return {error.code(), error.faults(), {}}; }

}  // namespace

std::string command_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    const bool quote = word.empty() || word.find_first_of(" \t\n'\"$*?;&|<>()") != std::string::npos;
    text += (text.empty() ? "" : " ") + (quote ? "'" + word + "'" : word);
  }
  return text;
}

StageContext open_call(const Stage& stage, const StageCall& call) {
  for (const auto& [name, value] : call.flags)
    if (const Flag* flag = flag_called(stage, name)) flag->set(value);
  StageContext opened{.recipe = recipe::Recipe(call.recipe, call.set),
                      .out = {},
                      .check_only = call.check_only,
                      .command_line = call.command.empty() ? command_of(stage, call) : call.command};
  const fs::path beside = opened.recipe.file().parent_path() / "out";
  opened.out = call.out.empty() ? beside : fs::absolute(call.out).lexically_normal();
  if (!call.out.empty()) show_path_as(opened.out, call.out.lexically_normal().string(), call.out.filename().string());
  if (stage.part) opened.part = stage.part();
  return opened;
}

StageOutcome call_stage(const Stage& stage, const StageCall& call) {
  return outcome_of([&] { return carry_out(stage, call); });
}

StageOutcome outcome_of(const std::function<std::vector<fs::path>()>& work) {
  try {
    return {ExitCode::success, {}, work()};
  } catch (const Error& error) {
    return outcome_of_error(error);
  } catch (const std::bad_alloc&) {
    return outcome_of_error(DataError({"the scene does not fit into memory", "an allocation failed",
                                       "Take a larger spacing, fewer points per cell or a smaller extent"}));
  } catch (const std::ios_base::failure& error) {  // what a stream throws where the disk fails under it
    return outcome_of_error(DataError({"a file cannot be read or written", error.what(),
                                       "Look at the disk or the network that it is on, and run it again"}));
  } catch (const std::exception& error) {
    return {ExitCode::bug,
            {{fmt::format("{} (this is a bug). Please report it, with the recipe and the version: {}", error.what(),
                          version()),
              "", ""}},
            {}};
  }
}

int report_faults(const std::string& program, const StageOutcome& outcome) {
  for (const Fault& fault : outcome.faults) log_error(program + ": " + to_string(fault));
  return static_cast<int>(outcome.code);
}

void print_results(const std::vector<fs::path>& results) {
  clear_progress_line();
  for (const fs::path& path : results) fmt::print("{}\n", path.string());
  errno = 0;
  if (std::fflush(stdout) != 0)
    throw DataError({"stdout: cannot be written", std::generic_category().message(errno),
                     "The results themselves are in the output folder"});
}

int run_stage(int argc, char** argv, const Stage& stage) {
  report_crashes(stage.name);
  Context own;
  const BindContext bind(own);
  StageOutcome outcome;
  const StageOutcome whole = outcome_of([&] {
    outcome = run_words(argc, argv, stage);
    print_results(outcome.results);
    return std::vector<fs::path>{};
  });
  return report_faults(stage.name, whole.code == ExitCode::success ? outcome : whole);
}

}  // namespace talus
