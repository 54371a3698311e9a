// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-validate: runs the cases through the programs, prints the table, writes validation.json and the pictures.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <exception>

#include "common/stage/stage.hpp"
#include "tests/validation/cases.hpp"
#include "tests/validation/report.hpp"

namespace {

using namespace talus;
using namespace talus::validation;
namespace fs = std::filesystem;

struct Case {
  const char* name;  // as in validation.md; up to a hyphen that of its recipe's folder
  const char* title;
  bool quick;  // has rows that need no LONG=1
  void (*run)(Bench&);
  bool coarse = false;  // has rows on coarse grids, seconds a case
};

constexpr Case cases[] = {
    {"A1", "self-weight column", true, self_weight_column},
    {"A1b", "column compacted to a third", true, large_compaction},
    {"A2", "cantilever with a load at its tip", true, cantilever},
    {"A2-loads", "cantilever under growing load", false, cantilever_loads},
    {"A2-studies", "cantilever over points per cell and load steps", false, cantilever_studies},
    {"A3", "collapse of a sand column", true, sand_column, true},
    {"A3-paper", "the same on the paper's grid with its 64 points per cell", false, sand_column_paper},
    {"A3-studies", "reach of the sand column over points per cell and step", false, sand_column_studies},
    {"A3-friction", "run-out of the sand column over damping and base friction", false, sand_column_friction},
    {"A3b", "sand columns of other aspect ratios", false, sand_column_aspects, true},
    {"A3c", "round columns of sand", false, round_sand_columns},
    {"A4", "time and memory of a step", true, step_cost},
    {"B1", "block on an incline", true, block_on_incline},
    {"B2", "block on a bed that weakens with speed", true, velocity_weakening},
    {"B3", "heap on curved ground, facing any direction", true, energy_line, true},
    {"B4", "parabolic cap on a plane", true, parabolic_cap, true},
    {"B5", "dam break on a slope", true, dam_break, true},
    {"B6", "vibrating bar, free fall, patch test", true, elastic_motion},
    {"B7", "block on shaking ground", true, shaken_block},
    {"B8", "blocks of unknown friction, an ensemble", true, blocks_of_unknown_friction, true},
    {"C1", "sand column in long steps", true, large_steps, true},
    {"D1", "factor of safety of a homogeneous slope", true, homogeneous_slope, true},
    {"D2", "the same on a foundation layer", true, slope_on_foundation},
    {"D3", "factor of safety of a slope on a weak seam", true, slope_on_seam},
    {"D4", "factor of safety of a wedge", true, rock_wedge},
    {"D5", "factor of safety of an undrained vertical cut", true, undrained_cut},
    {"E1", "round columns of beads in a fluid", false, wet_columns},
    {"E2", "release in a debris-flow flume", false, debris_flow_flume},
};

struct Words {
  std::vector<std::string> names;
  std::string on = "auto", out, programs, recipes = TALUS_RECIPES;
  std::string commit = version(), costs;
  bool complete = false, coarse = false, list = false, record = false;
};

Words parse(int argc, char** argv) {
  CLI::App app("Run the validation cases and print error beside tolerance.", "talus-validate");
  Words w;
  app.add_option("case", w.names, "Cases to run (default: all)")->type_name("A1 B2 ...");
  app.add_flag("--long", w.complete, "With the runs that take minutes to hours");
  app.add_option("--on", w.on, "Where talus-solve runs")
      ->type_name("auto|cpu|gpu")
      ->check(CLI::IsMember({"auto", "cpu", "gpu"}));
  app.add_option("--out", w.out,
                 "Folder for runs, pictures and table (default: validation beside the programs' folder)");
  app.add_option("--programs", w.programs, "Folder of the programs (default: that of this one)");
  app.add_option("--recipes", w.recipes, "Folder with the cases' recipes");
  app.add_flag("--coarse", w.coarse, "On coarse grids alone: seconds a case")->excludes("--long");
  app.add_option("--commit", w.commit, "What the table calls the programs' commit (default: that of the build)");
  app.add_option("--costs", w.costs, "The book of what runs have cost (default: costs.toml among the recipes)");
  app.add_flag("--record-costs", w.record, "Write what these runs cost into that book, instead of judging it");
  app.add_flag("--list", w.list, "Name the cases and stop");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error) == 0 ? 0 : 2);
  }
  for (const auto& name : w.names) {
    if (std::ranges::any_of(cases, [&](const Case& c) { return name == c.name; })) continue;
    fmt::print(stderr, "talus-validate: {}: no such case. talus-validate --list names them\n", name);
    std::exit(2);
  }
  return w;
}

bool wanted(const Words& words, const Case& c) {
  if (words.coarse ? !c.coarse : !c.quick && !words.complete) return false;
  return words.names.empty() || std::ranges::find(words.names, c.name) != words.names.end();
}

/// Runs the cases; returns what they cost.
CostBook run_cases(const Words& words, const Request& request, std::vector<Row>& rows) {
  Sitting sitting{.commit = words.commit,
                  .date = fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))),
                  .on = words.on,
                  .complete = words.complete,
                  .coarse = words.coarse,
                  .cases = {}};
  const auto keep = [&](const Row& row) {  // at once, so that what is there survives a long run that is stopped
    rows.push_back(row);
    write_text(request.out.parent_path() / (request.out.filename().string() + ".json"), as_json(sitting, rows));
  };
  CostBook costs;
  for (const Case& c : cases)
    if (wanted(words, c)) sitting.cases.emplace_back(c.name);
  for (const Case& c : cases) {
    if (!wanted(words, c)) continue;
    fmt::print(stderr, "{}: {}\n", c.name, c.title);
    Bench bench(c.name, request, keep);
    c.run(bench);
    for (const auto& [run, cost] : bench.costs()) costs[run] = cost;
  }
  return costs;
}

int run(const Words& words) {
  const fs::path here = fs::read_symlink("/proc/self/exe").parent_path();
  Request request;
  request.programs = words.programs.empty() ? here : fs::absolute(words.programs);
  request.recipes = fs::absolute(words.recipes);
  request.out = words.out.empty() ? here.parent_path() / "validation" : fs::absolute(words.out);
  request.on = words.on;
  request.complete = words.complete;
  fs::create_directories(request.out);
  request.coarse = words.coarse;
  const fs::path book = words.costs.empty() ? request.recipes / "costs.toml" : fs::absolute(words.costs);
  CostBook known = read_costs(book);
  if (!words.record) request.costs = known;
  std::vector<Row> rows;
  const CostBook costs = run_cases(words, request, rows);
  fmt::print("{}", as_table(rows));
  if (words.record) {
    for (const auto& [name, cost] : costs) known[name] = cost;
    write_text(book, as_toml(known));
    fmt::print(stderr, "{}\n", book.string());
  }
  const Counts c = count(rows);
  return rows.empty() || c.missed + c.lost > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  const Words words = parse(argc, argv);
  if (words.list) {
    for (const Case& c : cases) fmt::print("{:11} {}{}\n", c.name, c.title, c.quick ? "" : " (--long only)");
    return 0;
  }
  try {
    return run(words);
  } catch (const std::exception& error) {
    fmt::print(stderr, "talus-validate: {}\n", error.what());
    return 2;
  }
}
