// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <deque>
#include <ios>
#include <new>
#include <optional>
#include <system_error>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include "common/recipe/paths.hpp"
#include "common/stage/context.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/inside.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr int most_threads = 4096;

struct CommandLine {
  StageCall call;      ///< its recipe is empty where none was given
  std::string answer;  ///< text for stdout that --help or --version asks for
  bool print_template = false;
  bool network = false;  ///< inputs may name places on a network
  int threads = 0;       ///< to take at most; 0: as many as this process may run at once
  Verbosity verbosity = Verbosity::normal;
};

/// A flag of the stage's own on the command line.
struct Own {
  Flag flag;
  CLI::Option* option = nullptr;
  std::string value = {};

  bool may_go_without_value() const { return flag.value.starts_with('['); }
};

struct Words {
  std::string recipe, out;
  bool verbose = false, quiet = false, version = false;
  std::deque<Own> own = {};  // CLI11 keeps pointers to the values
};

/// Every stage takes --on, so that one command line serves all; stages that run no kernels pass it over.
Flag unheeded_on() {
  return {.name = "--on",
          .help = "This stage runs on the CPU whatever is asked",
          .choices = {"auto", "cpu", "gpu", "gpus"},
          .set = [](const std::string&) {}};
}

std::vector<Flag> own_flags(const Stage& stage) {
  std::vector<Flag> flags = stage.flags;
  if (std::ranges::find(flags, "--on", &Flag::name) == flags.end()) flags.insert(flags.begin(), unheeded_on());
  return flags;
}

/// "auto|cpu|gpu", "[FILE]", or nothing.
std::string shown_value(const Flag& flag) {
  return flag.choices.empty() ? flag.value : fmt::format("{}", fmt::join(flag.choices, "|"));
}

void declare(CLI::App& app, Own& own) {
  const Flag& flag = own.flag;
  if (shown_value(flag).empty()) {
    own.option = app.add_flag(flag.name, flag.help);
    return;
  }
  own.option = app.add_option(flag.name, own.value, flag.help)->type_name(shown_value(flag));
  if (!flag.choices.empty()) own.option->check(CLI::IsMember(flag.choices).description(""));
  if (own.may_go_without_value()) own.option->expected(0, 1);
}

void declare(CLI::App& app, const Stage& stage, CommandLine& line, Words& words) {
  app.add_option("recipe", words.recipe, "The scene's recipe (TOML)")->type_name("recipe.toml");
  app.add_option("--out", words.out, "Folder for the results, made if missing (default: out, beside the recipe)")
      ->type_name("DIR");
  app.add_option("--set", line.call.set,
                 "A value that takes the place of the recipe's (solve.end_time_s=60); may be given many times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_flag("--check", line.call.check_only, "Read and test everything cheap; compute and write nothing");
  app.add_flag("--if-outdated", line.call.if_outdated, "Do nothing but print the results where they are up to date");
  app.add_flag("--template", line.print_template,
               "Print this stage's recipe table with every key, its default and its meaning");
  app.add_option("--threads", line.threads,
                 fmt::format("Threads to take at most (default: as many as this process may run at once, {} here)",
                             usable_threads()))
      ->type_name("N")
      ->check(CLI::Range(1, most_threads).description(""));
  app.add_flag("--network", line.network, "Let inputs name places on a network and databases, which GDAL then opens");
  for (Flag& flag : own_flags(stage)) declare(app, words.own.emplace_back(Own{std::move(flag)}));
  auto* verbose = app.add_flag("-v,--verbose", words.verbose, "Say more");
  app.add_flag("-q,--quiet", words.quiet, "Say nothing but errors")->excludes(verbose);
  app.add_flag("--version", words.version, "Print the version and its commit");
}

/// `--restart recipe.toml` without another word: the recipe was meant, not the value that --restart may go without.
void return_recipe(Words& words) {
  for (Own& own : words.own)
    if (words.recipe.empty() && own.may_go_without_value() && own.value.ends_with(".toml"))
      std::swap(words.recipe, own.value);
}

/// "Usage: talus-solve recipe.toml [--out DIR] ..."
std::string usage(const Stage& stage) {
  std::string own;
  for (const Flag& flag : own_flags(stage)) {
    const std::string value = shown_value(flag);
    own += fmt::format(" [{}{}{}]", flag.name, value.empty() ? "" : " ", value);
  }
  return fmt::format(
      "Usage: {} recipe.toml [--out DIR] [--set KEY=VALUE] [--check] [--template] [--threads N]{} [-v|-q] (all of it: "
      "{} --help)",
      stage.name, own, stage.name);
}

/// Reads the options that every stage has, and those of stage.flags. Throws RecipeError when one is unknown or wrong.
CommandLine parse_command_line(int argc, char** argv, const Stage& stage) {
  CommandLine line;
  Words words;
  CLI::App app(stage.summary, stage.name);
  declare(app, stage, line, words);
  app.footer((stage.examples.empty() ? "" : "Examples:\n" + stage.examples + "\n\n") + exit_codes);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    line.answer = app.help();
    return line;
  } catch (const CLI::ParseError& error) {
    throw RecipeError(Fault{error.what(), "", usage(stage)});
  }
  if (words.version) line.answer = stage.name + " " + version() + "\n";
  return_recipe(words);
  for (const Own& own : words.own)
    if (own.option->count() > 0) line.call.flags.emplace_back(own.flag.name, own.value);
  line.call.recipe = words.recipe;
  line.call.out = words.out;
  if (words.quiet) line.verbosity = Verbosity::quiet;
  if (words.verbose) line.verbosity = Verbosity::verbose;
  return line;
}

/// --check writes nothing, so it asks for the permissions of the nearest folder that is there.
void check_output_folder(const fs::path& folder) {
  fs::path nearest = folder;
  while (!fs::exists(nearest) && nearest.has_relative_path()) nearest = nearest.parent_path();
  errno = fs::is_directory(nearest) ? 0 : ENOTDIR;
  if (errno != 0 || ::access(nearest.c_str(), W_OK | X_OK) != 0) refuse_output_folder(folder, reason_of(errno));
}

void make_output_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) refuse_output_folder(folder, error.message());
}

/// The flag of a stage by its name; null where it has none of it (--on of a stage without kernels).
const Flag* flag_called(const Stage& stage, const std::string& name) {
  const auto found = std::ranges::find(stage.flags, name, &Flag::name);
  return found == stage.flags.end() ? nullptr : &*found;
}

bool writes_nothing(const Stage& stage, const StageCall& call) {
  return call.check_only || std::any_of(call.flags.begin(), call.flags.end(), [&](const auto& given) {
           const Flag* flag = flag_called(stage, given.first);
           return flag != nullptr && flag->writes_nothing;
         });
}

/// Words as a shell takes them.
std::string command_text(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    const bool quote = word.empty() || word.find_first_of(" \t\n'\"$*?;&|<>()") != std::string::npos;
    text += (text.empty() ? "" : " ") + (quote ? "'" + word + "'" : word);
  }
  return text;
}

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

/// The file of what a stage said: OUT/STAGE.log, of a part OUT/STAGE.PART.log.
fs::path log_of(const Stage& stage, const StageContext& context) { return file_of(stage, context, ".log"); }

void keep_log(const Stage& stage, const StageContext& context, const std::string& said) {
  write_text(log_of(stage, context), fmt::format("{}, {}: {}\n{}", version(), utc_now(), context.command_line, said));
}

/// Throws, before long work begins, where a result could not take its name at the end. A fault of the recipe is left to
/// the stage.
void check_names_of_results(const Stage& stage, const StageContext& context) {
  require_replaceable(log_of(stage, context));
  if (!stage.depends) return;
  std::vector<fs::path> results;
  try {
    results = stage.depends(context).results;
  } catch (const Error&) {
    return;
  }
  for (const fs::path& file : results) require_replaceable(file);
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

/// Runs the stage and returns what it logged. Where the computation fails or is stopped that is kept; a refusal leaves
/// the log of the results that are there.
std::string run_recorded(const Stage& stage, StageContext& opened, Findings& found) {
  context().start_record();
  try {
    found.settled([&] { stage.run(opened); });
  } catch (const Error& error) {
    const std::string said = context().end_record();
    if (error.code() != ExitCode::numerical && error.code() != ExitCode::interrupted) throw;
    try {
      keep_log(stage, opened, said + error.what() + "\n");
    } catch (const DataError& second) {
      log_warning(second.what());
    }
    throw;
  } catch (...) {
    context().end_record();
    throw;
  }
  return context().end_record();
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
  check_names_of_results(stage, opened);
  opened.made_of = ingredients_before(stage, opened);
  const std::string said = run_recorded(stage, opened, found);
  if (has_made_results(stage, opened)) note_results(stage, opened);
  keep_log(stage, opened, said);
  log_detail(fmt::format("{}: {:.2f} s after the process began", stage.name, age_of_process()));
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
  CommandLine line = parse_command_line(argc, argv, stage);
  if (!line.answer.empty()) return fmt::print("{}", line.answer), StageOutcome{};
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

StageContext open_call(const Stage& stage, const StageCall& call) {
  for (const auto& [name, value] : call.flags)
    if (const Flag* flag = flag_called(stage, name)) flag->set(value);
  StageContext opened{.recipe = recipe::Recipe(call.recipe, call.set),
                      .out = {},
                      .check_only = call.check_only,
                      .command_line = call.command.empty() ? command_of(stage, call) : call.command};
  const fs::path beside = opened.recipe.file().parent_path() / "out";
  opened.out = call.out.empty() ? beside : fs::absolute(call.out).lexically_normal();
  refuse_name_beyond_utf8(opened.out);
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

/// Every path for a program that reads on; for a person at a terminal, who did not ask for more, the page to look at
/// or the first result in the folder itself, and how many there are.
void print_results(const std::vector<fs::path>& results) {
  clear_progress_line();
  if (results.size() > 3 && isatty(STDOUT_FILENO) != 0 && context().verbosity != Verbosity::verbose) {
    const auto depth = [](const fs::path& path) {
      return std::pair(path.extension() != ".html", std::distance(path.begin(), path.end()));
    };
    fmt::print("{} ({} files in all; -v lists them)\n", std::ranges::min_element(results, {}, depth)->string(),
               results.size());
  } else {
    for (const fs::path& path : results) fmt::print("{}\n", path.string());
  }
  errno = 0;
  if (std::fflush(stdout) != 0)
    throw DataError({"stdout: cannot be written", reason_of(errno), "The results themselves are in the output folder"});
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
