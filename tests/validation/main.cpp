// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-validate: runs the validation cases through the programs, prints the table, writes validation.json and the
// pictures.
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
    bool known = false;
    for (const Case& c : cases()) known = known || name == c.name;
    if (known) continue;
    fmt::print(stderr, "talus-validate: {}: no such case. talus-validate --list names them\n", name);
    std::exit(2);
  }
  return w;
}

bool wanted(const Words& words, const Case& c) {
  if (words.coarse ? !c.coarse : !c.quick && !words.complete) return false;
  if (words.names.empty()) return true;
  return std::find(words.names.begin(), words.names.end(), c.name) != words.names.end();
}

/// Today, as 2026-11-22.
std::string today() { return fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time(nullptr))); }

/// Runs the cases; returns what they cost.
CostBook run_cases(const Words& words, const Request& request, std::vector<Row>& rows) {
  Sitting sitting{.commit = words.commit,
                  .date = today(),
                  .on = words.on,
                  .complete = words.complete,
                  .coarse = words.coarse,
                  .cases = {}};
  const auto keep = [&](const Row& row) {  // at once, so that what is there survives a long run that is stopped
    rows.push_back(row);
    write_text(request.out.parent_path() / (request.out.filename().string() + ".json"), as_json(sitting, rows));
  };
  CostBook costs;
  for (const Case& c : cases()) {
    if (wanted(words, c)) sitting.cases.emplace_back(c.name);
  }
  for (const Case& c : cases()) {
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
    for (const Case& c : cases()) fmt::print("{:11} {}{}\n", c.name, c.title, c.quick ? "" : " (--long only)");
    return 0;
  }
  try {
    return run(words);
  } catch (const std::exception& error) {
    fmt::print(stderr, "talus-validate: {}\n", error.what());
    return 2;
  }
}
