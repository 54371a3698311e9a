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
  void (*run)(Bench&);
  bool quick;           // has rows that need no LONG=1
  bool coarse = false;  // has rows on coarse grids, seconds a case
};

constexpr Case cases[] = {
    {"A1", "self-weight column", self_weight_column, true},
    {"A1b", "column compacted to a third", large_compaction, true},
    {"A2", "cantilever with a load at its tip", cantilever, true},
    {"A2-loads", "cantilever under growing load", cantilever_loads, false},
    {"A2-studies", "cantilever over points per cell and load steps", cantilever_studies, false},
    {"A3", "collapse of a sand column", sand_column, true, true},
    {"A3-paper", "the same on the paper's grid with its 64 points per cell", sand_column_paper, false},
    {"A3-studies", "reach of the sand column over points per cell and step", sand_column_studies, false},
    {"A3-friction", "run-out of the sand column over damping and base friction", sand_column_friction, false},
    {"A3b", "sand columns of other aspect ratios", sand_column_aspects, false, true},
    {"A3c", "round columns of sand", round_sand_columns, false},
    {"A4", "time and memory of a step", step_cost, true},
    {"B1", "block on an incline", block_on_incline, true},
    {"B2", "block on a bed that weakens with speed", velocity_weakening, true},
    {"B3", "heap on curved ground, facing any direction", energy_line, true, true},
    {"B4", "parabolic cap on a plane", parabolic_cap, true, true},
    {"B5", "dam break on a slope", dam_break, true, true},
    {"B6", "vibrating bar, free fall, patch test", elastic_motion, true},
    {"B7", "block on shaking ground", shaken_block, true},
    {"B8", "blocks of unknown friction, an ensemble", blocks_of_unknown_friction, true, true},
    {"C1", "sand column in long steps", large_steps, true, true},
    {"D1", "factor of safety of a homogeneous slope", homogeneous_slope, true, true},
    {"D2", "the same on a foundation layer", slope_on_foundation, true},
    {"D3", "factor of safety of a slope on a weak seam", slope_on_seam, true},
    {"D4", "factor of safety of a wedge", rock_wedge, true},
    {"D5", "factor of safety of an undrained vertical cut", undrained_cut, true},
    {"E1", "round columns of beads in a fluid", wet_columns, false},
    {"E2", "release in a debris-flow flume", debris_flow_flume, false},
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
      ->type_name("auto|cpu|gpu|gpus")
      ->check(CLI::IsMember({"auto", "cpu", "gpu", "gpus"}));
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
