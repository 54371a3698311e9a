// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus: one command over the stages.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string_view>

#include "common/error.hpp"
#include "common/recipe/paths.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/context.hpp"
#include "common/stage/signals.hpp"
#include "common/stage/stage.hpp"
#include "solver/stage.hpp"
#include "talus/commands.hpp"

namespace {

using namespace talus;
using namespace talus::command;

constexpr const char* footer =
    "Examples:\n"
    "  talus run my-slide/recipe.toml                     every stage whose results are not up to date\n"
    "  talus run recipe.toml --set solve.end_time_s=60    with another value than the recipe's\n"
    "  talus run recipe.toml --budget                     how sure the run is, doubt by doubt\n"
    "  talus run recipe.toml --plan                       what the run takes: points, steps, time\n"
    "  talus new before.tif after.tif                     a first recipe: spacing, layers and end time from the "
    "release\n"
    "  talus new dem.tif outline.gpkg --volume 2e5        the same of a slope that may fail, with its doubts\n"
    "  talus fit recipe.toml                              the friction with which the run agrees with the survey\n"
    "  talus calibrate recipe.toml                        how sure that is, and what follows for the maps\n"
    "  talus check recipe.toml                            every fault of all stages, nothing is written\n"
    "  talus compare out-a out-b                          two runs beside one another: out-a/comparison.html\n"
    "  talus data cascade2021                             a public example, fetched and checked\n"
    "\n";

/// Words of the command line, and what is to be done with them.
struct Asked {
  Request request;
  std::string recipe, out;
  bool json = false;  ///< the log goes to stderr as lines of JSON
  std::function<int()> command;
};

/// Writes a line of the log as an object: level and text, of progress the percent too.
void write_json(LogLevel level, const std::string& text) {
  constexpr const char* names[] = {"detail", "progress", "info", "advice", "warning", "error"};
  nlohmann::json line{{"level", names[static_cast<int>(level)]}, {"text", text}};
  char* behind = nullptr;
  const long percent = std::strtol(text.c_str(), &behind, 10);
  if (level == LogLevel::progress && std::string_view(behind).starts_with(" %")) line["percent"] = percent;
  fmt::print(stderr, "{}\n", line.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
}

void declare_scene(CLI::App& app, Asked& asked) {
  app.add_option("recipe", asked.recipe, "The scene's recipe (TOML)")->type_name("recipe.toml")->required();
  app.add_option("--out", asked.out, "Folder of the results (default: out, beside the recipe)")->type_name("DIR");
  app.add_option("--set", asked.request.set, "A value that takes the place of the recipe's; may be given many times")
      ->type_name("KEY=VALUE")
      ->allow_extra_args(false);
  app.add_option("--on", asked.request.on,
                 "Where talus-solve runs; auto: on the GPU where there is one; gpus: one run on all GPUs")
      ->type_name("auto|cpu|gpu|gpus")
      ->check(CLI::IsMember({"auto", "cpu", "gpu", "gpus"}).description(""));
  app.add_option("--threads", asked.request.threads, "Threads to take at most")
      ->type_name("N")
      ->check(CLI::Range(1, 4096).description(""));
  app.add_flag("--network", asked.request.network, "Let inputs name places on a network");
}

void declare_budget(CLI::App& app, Asked& asked) {
  app.add_flag_callback(
      "--budget", [&asked] { asked.request.set.emplace_back("ensemble.design=budget"); },
      "Run single changes of the recipe instead (design = \"budget\"): how far each doubt moves the deposit");
}

/// The request of a command over a scene, with its paths settled.
Request scene_request(const Asked& asked) {
  Request request = asked.request;
  request.recipe = asked.recipe;
  request.shown = asked.out;
  const auto folder = std::filesystem::absolute(request.recipe).lexically_normal().parent_path();
  request.out = asked.out.empty() ? folder / "out" : std::filesystem::absolute(asked.out).lexically_normal();
  if (request.out.filename().empty()) request.out = request.out.parent_path();
  ::setenv("TALUS_RESULTS", request.out.c_str(), 1);  // recipes may name what a search before them has found there
  if (!asked.out.empty()) show_path_as(request.out, asked.out, request.out.filename().string());
  return request;
}

void declare(CLI::App& app, Asked& asked) {
  CLI::App* run = app.add_subcommand("run", "Run the stages of a scene whose results are not up to date");
  declare_scene(*run, asked);
  declare_budget(*run, asked);
  run->add_flag("--plan", asked.request.plan,
                "Prepare the domain and print points, memory, steps and the time to expect; run no solver");
  run->add_flag("--json", asked.json, "The log on stderr as lines of JSON: level, text, of progress the percent");
  run->callback([&] { asked.command = [&] { return run_scene(scene_request(asked)); }; });
  CLI::App* check = app.add_subcommand("check", "Every fault of all stages in one listing; writes nothing");
  declare_scene(*check, asked);
  declare_budget(*check, asked);
  check->callback([&] { asked.command = [&] { return check_scene(scene_request(asked)); }; });
  CLI::App* fit = app.add_subcommand(
      "fit",
      "Change the friction (or the keys of [fit]) from run to run until the run agrees with the survey; write\n"
      "fitted.toml beside the recipe, and run it");
  declare_scene(*fit, asked);
  fit->callback([&] { asked.command = [&] { return fit_scene(scene_request(asked)); }; });
  CLI::App* calibrate = app.add_subcommand(
      "calibrate",
      "Draw the keys of [[ensemble.vary]] as the survey makes them probable: runs the scene many times; writes\n"
      "posterior.csv, fitted.toml beside the recipe, and the probability maps of the draws");
  declare_scene(*calibrate, asked);
  calibrate->callback([&] { asked.command = [&] { return calibrate_scene(scene_request(asked)); }; });
}

void declare_new(CLI::App& app, NewScene& scene, Asked& asked) {
  CLI::App* command = app.add_subcommand(
      "new", "Write a recipe for a slide from the elevation models before and after, or from one and an outline");
  command->add_option("before", scene.before, "Elevation model from before the slide")->type_name("BEFORE")->required();
  command->add_option("after", scene.after, "Elevation model from after it, or the outline of what may fail (polygons)")
      ->type_name("AFTER")
      ->required();
  command->add_option("--recipe", scene.recipe, "File to be written (default: recipe.toml)")->type_name("FILE");
  auto* at = command->add_option("--at", scene.at, "A point in the slide, where it is not found (seed_m)")
                 ->type_name("X,Y")
                 ->delimiter(',')
                 ->expected(2);
  command->add_option("--outline", scene.outline, "Outline of its source (polygon)")->type_name("FILE")->excludes(at);
  command->add_option("--ignore", scene.ignore, "Polygons of ground to leave out: lakes, quarries, forest (ignore)")
      ->type_name("FILE");
  command->add_option("--thickness", scene.thickness, "Of what fails within an outline, everywhere [m]")
      ->type_name("M");
  command->add_option("--volume", scene.volume, "Of what fails, above a curved sliding surface [m3]")->type_name("M3");
  command
      ->add_option("--depth", scene.depth, "Of such a surface, at most [m] (default: volume from the outline's area)")
      ->type_name("M");
  command
      ->add_option("--prior", scene.prior,
                   "Friction of what fails: posterior.csv of another event, or its class (rock-avalanche)")
      ->type_name("FILE");
  command->add_flag("--overwrite", scene.overwrite, "Write over a recipe that is there already");
  command->callback([&] { asked.command = [&] { return new_scene(scene); }; });
}

/// The folders of two runs.
struct Pair {
  std::filesystem::path first, second;
};

void declare_compare(CLI::App& app, Pair& pair, Asked& asked) {
  CLI::App* command = app.add_subcommand("compare", "Two runs on one page: FIRST/comparison.html");
  command->add_option("first", pair.first, "Folder of results of a run")->type_name("FIRST")->required();
  command->add_option("second", pair.second, "Folder of another, which is compared with it")
      ->type_name("SECOND")
      ->required();
  command->callback([&] { asked.command = [&] { return compare_runs(pair.first, pair.second, asked.request); }; });
}

void declare_data(CLI::App& app, DataRequest& data, Asked& asked) {
  CLI::App* command = app.add_subcommand("data", "List the public examples, or make one of them");
  command->add_option("name", data.name, "Example to be made (default: list them)")->type_name("NAME");
  command->add_option("--out", data.out, "Folder in which that of the example is made (default: data)")
      ->type_name("DIR");
  command
      ->add_option("--from", data.from,
                   "Folder that holds its sources, or its files (default: the sources are fetched)")
      ->type_name("DIR");
  command->add_flag("--exact", data.exact, "Refuse files whose SHA-256 is another one, or not known");
  command->add_option("--table", data.table, "A table of examples of one's own (TOML)")->type_name("FILE");
  command->callback([&] { asked.command = [&] { return make_data(data); }; });
}

/// `json` takes over the log where the command line asks for that.
int guarded(int argc, char** argv, std::optional<RedirectLog>& json) {
  Asked asked;
  CLI::App app("One command over the stages of Talus", "talus");
  app.require_subcommand(0, 1);
  app.fallthrough();
  app.footer(std::string(footer) + exit_codes);
  auto* verbose = app.add_flag("-v,--verbose", asked.request.verbose, "Say more");
  app.add_flag("-q,--quiet", asked.request.quiet, "Say nothing but errors")->excludes(verbose);
  bool asks_version = false;
  app.add_flag("--version", asks_version, "Print the version and its commit");
  declare(app, asked);
  NewScene scene{.before = {}, .after = {}, .recipe = "recipe.toml"};
  declare_new(app, scene, asked);
  Pair pair;
  declare_compare(app, pair, asked);
  DataRequest data{.name = {}, .out = "data", .from = {}, .exact = false, .table = {}};
  declare_data(app, data, asked);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    const auto chosen = app.get_subcommands();
    fmt::print("{}", chosen.empty() ? app.help() : chosen.front()->help());
    return 0;
  } catch (const CLI::ParseError& error) {
    throw RecipeError(Fault{error.what(), "", "See talus --help, or talus COMMAND --help"});
  }
  if (asks_version) return fmt::print("talus {}\n", version()), 0;
  if (!asked.command) throw RecipeError(Fault{"no command was given", "", "See talus --help"});
  Context& own = context();
  if (asked.request.quiet) own.verbosity = Verbosity::quiet;
  if (asked.request.verbose) own.verbosity = Verbosity::verbose;
  own.threads = asked.request.threads;
  own.network = asked.request.network;
  if (!app.got_subcommand("data")) watch_for_interrupts("talus");
  if (asked.json) json.emplace(write_json);
  return asked.command();
}

/// The command, and the exit code of its process.
int run(int argc, char** argv) {
  report_crashes("talus");
  h5::prepare_library();
  Context own;
  const BindContext bind(own);
  std::optional<RedirectLog> json;
  int code = 0;
  const StageOutcome outcome = outcome_of([&] {
    code = guarded(argc, argv, json);
    return std::vector<std::filesystem::path>{};
  });
  if (outcome.code != ExitCode::success) code = report_faults("talus", outcome);
  if (code == static_cast<int>(ExitCode::interrupted)) fmt::print(stderr, "talus: the same command goes on\n");
  return code;
}

}  // namespace

int main(int argc, char** argv) { solver::end_process(run(argc, argv)); }
