#include "common/stage/command_line.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>

namespace talus {
namespace {

constexpr auto exit_codes =
    "Exit codes: 0 done, 1 a bug, 2 the recipe or the command line is wrong, 3 a file is wrong or cannot be written,\n"
    "4 the computation failed, 130 ended by Ctrl-C.\n"
    "Result paths go to stdout, everything for people to stderr.";

struct Words {
  std::string recipe, out, on = "auto", restart;
  bool verbose = false, quiet = false, version = false;
};

void declare(CLI::App& app, const Stage& stage, CommandLine& line, Words& words) {
  app.add_option("recipe", words.recipe, "The scene's recipe (TOML)")->type_name("recipe.toml");
  app.add_option("--out", words.out, "Folder for the results, made if missing (default: out, beside the recipe)")
      ->type_name("DIR");
  app.add_flag("--check", line.check_only, "Read and test everything cheap; compute and write nothing");
  app.add_flag("--template", line.print_template,
               "Print this stage's recipe table with every key, its default and its meaning");
  app.add_option("--on", words.on,
                 stage.has_on ? "Where to run; auto takes the GPU where there is one"
                              : "This stage runs on the CPU whatever is asked")
      ->type_name("auto|cpu|gpu")
      ->check(CLI::IsMember({"auto", "cpu", "gpu"}).description(""));
  if (stage.has_restart)
    app.add_option("--restart", words.restart, "Go on from a checkpoint (default: checkpoint.h5 in the results)")
        ->type_name("[FILE]")
        ->expected(0, 1);
  if (stage.has_profile)
    app.add_flag(
        "--profile", line.profile,
        "Measure where the time goes, phase by phase and kernel by kernel; say it at the end, and in profile.csv");
  if (stage.has_profile)
    app.add_flag("--plan", line.plan,
                 "Say what is on, points, memory, steps and the time to expect; run and write nothing");
  if (stage.has_difference)
    app.add_flag("--difference", line.difference,
                 "Compare before_dem and after_dem, write what changed with its error (OUT/survey), and stop");
  auto* verbose = app.add_flag("-v,--verbose", words.verbose, "Say more");
  app.add_flag("-q,--quiet", words.quiet, "Say nothing but errors")->excludes(verbose);
  app.add_flag("--version", words.version, "Print the version and its commit");
}

On place(const std::string& word) {
  if (word == "cpu") return On::cpu;
  return word == "gpu" ? On::gpu : On::automatic;
}

/// `--restart recipe.toml` without another word: the recipe was meant, not a checkpoint.
void untangle_restart(const CLI::App& app, CommandLine& line, Words& words) {
  if (app.get_option_no_throw("--restart") == nullptr || app.count("--restart") == 0) return;
  if (words.recipe.empty() && words.restart.ends_with(".toml")) std::swap(words.recipe, words.restart);
  line.restart = words.restart;
}

}  // namespace

std::string usage(const Stage& stage) {
  return fmt::format(
      "Usage: {} recipe.toml [--out DIR] [--check] [--template] [--on auto|cpu|gpu]{}{}{} [-v|-q] (all of it: {} "
      "--help)",
      stage.name, stage.has_restart ? " [--restart [FILE]]" : "", stage.has_profile ? " [--profile] [--plan]" : "",
      stage.has_difference ? " [--difference]" : "", stage.name);
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
  untangle_restart(app, line, words);
  line.recipe = words.recipe;
  line.out = words.out;
  line.on = place(words.on);
  if (words.quiet) line.verbosity = Verbosity::quiet;
  if (words.verbose) line.verbosity = Verbosity::verbose;
  return line;
}

}  // namespace talus
