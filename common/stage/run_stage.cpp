// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <ios>
#include <new>
#include <optional>
#include <system_error>

#include "common/recipe/overrides.hpp"
#include "common/recipe/shown_paths.hpp"
#include "common/stage/command_line.hpp"
#include "common/stage/console.hpp"
#include "common/stage/crash_report.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/interrupt.hpp"
#include "common/stage/machine.hpp"
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

std::string joined(int argc, char** argv) {
  std::string text;
  for (int i = 0; i < argc; ++i) {
    const std::string word = argv[i];
    const bool quote = word.empty() || word.find_first_of(" \t\n'\"$*?;&|<>()") != std::string::npos;
    text += (i == 0 ? "" : " ") + (quote ? "'" + word + "'" : word);
  }
  return text;
}

/// The paths below the output folder as --out was given, as compilers do with -MD; others as they are.
void show_as_given(std::vector<fs::path>& paths, const fs::path& out, const fs::path& given) {
  if (given.empty()) return;
  for (fs::path& path : paths) {
    const fs::path below = path.lexically_relative(out);
    if (!below.empty() && *below.begin() != "..") path = (given / below).lexically_normal();
  }
}

/// --used and --depends: what would go into the results.
void print_inputs(const CommandLine& line, const Stage& stage, const StageContext& context) {
  if (line.print_used) fmt::print("{}", own_recipe(context.recipe, stage.used_toml(context.recipe)));
  if (!line.print_depends) return;
  Dependencies depends = stage.depends(context);
  show_as_given(depends.results, context.out, line.out);
  show_as_given(depends.inputs, context.out, line.out);
  fmt::print("{}", make_rules(depends));
}

void run(const CommandLine& line, const std::string& command, const Stage& stage) {
  if (line.print_template) {
    fmt::print(
        "# {} {}, written by --template: every key with its default.\n"
        "# A recipe holds [scene] and the tables of all stages:\n"
        "# [scene]\n# name = \"my-scene\"\n# title = \"What the map is called\"\n\n{}",
        stage.name, version(), stage.template_toml());
    return;
  }
  if (line.recipe.empty()) throw RecipeError(Fault{"no recipe was given", "", usage(stage)});
  StageContext context{
      .recipe = recipe::Recipe(line.recipe), .out = {}, .check_only = line.check_only, .command_line = command};
  const fs::path beside = context.recipe.file().parent_path() / "out";
  context.out = line.out.empty() ? beside : fs::absolute(line.out).lexically_normal();
  if (!line.out.empty()) show_path_as(context.out, line.out.lexically_normal().string(), line.out.filename().string());
  if (line.print_used || line.print_depends) return print_inputs(line, stage, context);
  watch_for_interrupts(stage.name);
  std::optional<OutputLock> lock;
  if (line.writes_nothing) {
    check_output_folder(context.out);
  } else {
    make_output_folder(context.out);
    if (stage.part) context.part = stage.part();
    lock.emplace(context.out, stage.name,
                 context.part);  // shows besides that the folder takes anything, before long work begins
  }
  stage.run(context);
  clear_progress_line();
  for (const auto& path : context.results) fmt::print("{}\n", path.string());
}

int report(const Stage& stage, const Error& error) {
  for (const Fault& fault : error.faults()) log_error(stage.name + ": " + to_string(fault));
  return static_cast<int>(error.code());
}

int guarded(int argc, char** argv, const Stage& stage) {
  const auto parsed = parse_command_line(argc, argv, stage);
  if (const auto* answer = std::get_if<Answer>(&parsed)) {
    fmt::print("{}", answer->text);
  } else {
    const auto& line = std::get<CommandLine>(parsed);
    set_verbosity(line.verbosity);
    set_thread_limit(line.threads);
    allow_network(line.network);
    recipe::set_overrides(line.set);
    run(line, joined(argc, argv), stage);
  }
  errno = 0;
  if (std::fflush(stdout) != 0)
    throw DataError({"stdout: cannot be written", std::generic_category().message(errno),
                     "The results themselves are in the output folder"});
  return static_cast<int>(ExitCode::success);
}

}  // namespace

int run_stage(int argc, char** argv, const Stage& stage) {
  report_crashes(stage.name);
  try {
    return guarded(argc, argv, stage);
  } catch (const Error& error) {
    return report(stage, error);
  } catch (const std::bad_alloc&) {
    return report(stage, DataError({"the scene does not fit into memory", "an allocation failed",
                                    "Take a larger spacing, fewer points per cell or a smaller extent"}));
  } catch (const std::ios_base::failure& error) {  // what a stream throws where the disk fails under it
    return report(stage, DataError({"a file cannot be read or written", error.what(),
                                    "Look at the disk or the network that it is on, and run it again"}));
  } catch (const std::exception& error) {
    log_error(fmt::format("{}: {} (this is a bug). Please report it, with the recipe and the version: {}", stage.name,
                          error.what(), version()));
  }
  return static_cast<int>(ExitCode::bug);
}

}  // namespace talus
