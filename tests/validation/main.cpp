// talus-validate: runs the validation cases through the programs, prints the table, writes validation.json and the
// pictures.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <exception>
#include <filesystem>

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
  bool complete = false, list = false;
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
  if (words.names.empty()) return true;
  return std::find(words.names.begin(), words.names.end(), c.name) != words.names.end();
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
  std::vector<Row> rows;
  const auto keep = [&](const Row& row) {  // at once, so that what is there survives a long run that is stopped
    rows.push_back(row);
    write_text(request.out.parent_path() / (request.out.filename().string() + ".json"), as_json(rows));
  };
  for (const Case& c : cases()) {
    if (!wanted(words, c) || (!c.quick && !words.complete)) continue;
    fmt::print(stderr, "{}: {}\n", c.name, c.title);
    Bench bench(c.name, request, keep);
    c.run(bench);
  }
  fmt::print("{}", as_table(rows));
  if (rows.empty()) return 1;
  for (const Row& row : rows) {
    if (!row.pass) return 1;
  }
  return 0;
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
