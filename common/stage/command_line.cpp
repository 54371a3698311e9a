// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/command_line.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <deque>

#include "common/stage/machine.hpp"

namespace talus {
namespace {

constexpr auto exit_codes =
    "Exit codes: 0 done, 1 a bug, 2 the recipe or the command line is wrong, 3 a file is wrong or cannot be written,\n"
    "4 the computation failed, 130 ended by Ctrl-C.\n"
    "Result paths go to stdout, everything for people to stderr.";

constexpr int most_threads = 4096;

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
          .choices = {"auto", "cpu", "gpu"},
          .set = [](const std::string&) {}};
}

std::vector<Flag> own_flags(const Stage& stage) {
  std::vector<Flag> flags = stage.flags;
  const bool has_on = std::any_of(flags.begin(), flags.end(), [](const Flag& flag) { return flag.name == "--on"; });
  if (!has_on) flags.insert(flags.begin(), unheeded_on());
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

/// The stage's own flags.
void take_own(const Words& words, CommandLine& line) {
  for (const Own& own : words.own)
    if (own.option->count() > 0) line.call.flags.emplace_back(own.flag.name, own.value);
}

}  // namespace

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

std::variant<CommandLine, Answer> parse_command_line(int argc, char** argv, const Stage& stage) {
  CommandLine line;
  Words words;
  CLI::App app(stage.summary, stage.name);
  declare(app, stage, line, words);
  app.footer((stage.examples.empty() ? "" : "Examples:\n" + stage.examples + "\n\n") + exit_codes);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    return Answer{app.help()};
  } catch (const CLI::ParseError& error) {
    throw RecipeError(Fault{error.what(), "", usage(stage)});
  }
  if (words.version) return Answer{stage.name + " " + version() + "\n"};
  return_recipe(words);
  take_own(words, line);
  line.call.recipe = words.recipe;
  line.call.out = words.out;
  if (words.quiet) line.verbosity = Verbosity::quiet;
  if (words.verbose) line.verbosity = Verbosity::verbose;
  return line;
}

}  // namespace talus
