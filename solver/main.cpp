// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// talus-solve: domain.vdb -> run.h5.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/budget/budget.hpp"
#include "common/domain/domain.hpp"
#include "common/domain/threads.hpp"
#include "common/run/places.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "solver/budget/budget_stage.hpp"
#include "solver/ensemble/ensemble_stage.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/bandwidth.hpp"
#include "solver/parallel/on.hpp"
#include "solver/run/advice.hpp"
#include "solver/run/plan.hpp"
#include "solver/run/plausible.hpp"
#include "solver/run/profile_report.hpp"
#include "solver/run/run_inputs.hpp"
#include "solver/run/simulation.hpp"
#include "solver/run/stability/stability_products.hpp"
#include "solver/run/step_choice.hpp"
#include "solver/run/stiffness.hpp"
#include "solver/run/trial.hpp"
#include "solver/run/warnings.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace {

using namespace talus;
using namespace talus::solver;

const char* const examples =
    "  talus-solve recipe.toml --out out/valley            # as the recipe says, on a GPU where there is one\n"
    "  talus-solve recipe.toml --out out/valley --on cpu   # on the processor\n"
    "  talus-solve recipe.toml --out out/valley --restart  # go on after Ctrl-C\n"
    "  talus-solve recipe.toml --out out/valley --resume   # go on where there is something to go on from\n"
    "  talus-solve recipe.toml --out out/valley --plan     # say what is on, how many steps, how long; write nothing\n"
    "  talus-solve recipe.toml --out out/valley --members 0:250   # a part of an ensemble\n"
    "  talus-solve recipe.toml --out out/valley --budget   # and runs that differ in one thing each: how sure is it?\n"
    "  talus-solve recipe.toml --out out/valley --budget --plan   # what they take";

/// The arguments of the command line beyond those that every stage takes.
struct SolveFlags {
  On on = On::automatic;
  std::optional<std::filesystem::path> restart;  // empty path: OUT/checkpoint.h5
  bool resume = false;
  bool profile = false;
  bool plan = false;
  bool budget = false;
  std::optional<MemberRange> members;
};

On device_called(const std::string& word) {
  if (word == "cpu") return On::cpu;
  return word == "gpu" ? On::gpu : On::automatic;
}

/// The flags of talus-solve, each setting its member of `given`, which must outlive them.
std::vector<Flag> flags(SolveFlags& given) {
  return {{.name = "--on",
           .help = "Where to run; auto takes the GPU where there is one",
           .choices = {"auto", "cpu", "gpu"},
           .set = [&](const std::string& word) { given.on = device_called(word); }},
          {.name = "--restart",
           .help = "Go on from a checkpoint (default: checkpoint.h5 in the results)",
           .value = "[FILE]",
           .set = [&](const std::string& file) { given.restart = file; }},
          {.name = "--resume",
           .help = "Go on from checkpoint.h5 in the results where it is one of this run, else begin anew",
           .set = [&](const std::string&) { given.resume = true; }},
          {.name = "--members",
           .help = "Of an ensemble, members A to B-1 alone, counted from 0; talus-postprocess adds parts up",
           .value = "A:B",
           .set = [&](const std::string& words) { given.members = member_range(words); }},
          {.name = "--budget",
           .help = "Make the runs of the error budget too ([budget]): how far each doubt moves the deposit",
           .set = [&](const std::string&) { given.budget = true; }},
          {.name = "--profile",
           .help = "Measure where the time goes, phase by phase and kernel by kernel; say it at the end, and in "
                   "profile.csv",
           .set = [&](const std::string&) { given.profile = true; }},
          {.name = "--plan",
           .help = "Say what is on, points, memory, steps and the time to expect; run and write nothing",
           .writes_nothing = true,
           .set = [&](const std::string&) { given.plan = true; }}};
}

/// The [solve] and, where it is made, the [budget] of a recipe, as they are used.
std::string used_tables(const recipe::Recipe& recipe, bool budget_asked) {
  const BudgetOptions budget = budget_of(recipe, budget_asked);
  std::string text = recipe::to_toml(recipe.read<SolveOptions>("solve"), "solve", false);
  if (budget.make) text += "\n" + recipe::to_toml(budget, "budget", false);
  return text;
}

Stage stage() {
  Stage s;
  s.name = "talus-solve";
  s.table = "solve";
  s.summary = "Simulate the slide in three dimensions with the material point method: domain.vdb -> run.h5.";
  s.examples = examples;
  s.template_toml = [] {
    return recipe::to_toml(SolveOptions{}, "solve", true) +
           "\n# Runs that differ in one thing each, and say how sure the run is (--budget). All stages read this table.\n" +
           recipe::to_toml(BudgetOptions{}, "budget", true);
  };
  return s;
}

/// This function reports what was measured, in words and as profile.csv.
void report_profile(const RunSummary& summary, const AnyDevice& device, const std::filesystem::path& out) {
  Profile& profile = device.profile();
  profile.turn_off();
  const double copy = device.is_gpu() ? copy_bandwidth(device.gpu()) : copy_bandwidth(device.cpu());
  for (const std::string& text : profile_lines(summary, profile, copy)) log_info(text);
  write_text(out / "profile.csv", profile_csv(profile, copy));
}

/// One sentence on what will run: points, cells, first step.
void log_plan(const Domain& domain, const SolveOptions& o, const AnyDevice& device) {
  const Scene scene = make_scene(domain, o);
  const TerrainTables terrain = make_terrain_tables(scene.grid);
  const FirstWaves waves = first_waves(o);
  const double step = std::min(o.cfl / first_rate(scene.grid, terrain, scene.points, waves, 0), o.largest_step);
  const double volume = std::accumulate(scene.points.volume.begin(), scene.points.volume.end(), 0.0);
  log_info(fmt::format("{} material points, {:.0f} m3; grid {} x {} columns of {:g} m, layers of {:g} m",
                       scene.points.size(), volume, scene.grid.columns, scene.grid.rows, scene.grid.spacing,
                       scene.grid.layer_height));
  const auto whole = [](double number) {
    return fmt::format(fmt::runtime(number < 1e9 ? "{:.0f}" : "{:.3g}"), number);
  };
  log_info(fmt::format("wave speed {} m/s, first step {:.3g} s, about {} steps, on the {}", whole(waves.speed), step,
                       whole(o.end_time / step + records_of(o)), device.is_gpu() ? "GPU" : "CPU"));
}

/// What talus-preprocess warned of stands in the domain, so that it is said where the run is planned, too. What is
/// said here goes into the results: the facts "warning.solve.N" and "advice.NAME".
void log_warnings(Domain& domain, const SolveOptions& o) {
  for (const auto& [name, words] : domain.provenance)
    if (name.starts_with("warning.")) log_warning(words);
  Facts said;
  for (const std::string& text : warnings(domain, o)) {
    log_warning(text);
    said.emplace_back(fmt::format("warning.solve.{}", said.size()), text);
  }
  for (const auto& [name, words] : advice(domain, o)) {
    log_info("advice: " + words);
    said.emplace_back("advice." + name, words);
  }
  domain.provenance.insert(domain.provenance.end(), said.begin(), said.end());
}

/// Where the gauges of the run are, for its report; obstacles that the domain was made with and that the run leaves
/// out are no longer among its places.
void add_places(Domain& domain, const SolveOptions& o) {
  std::erase_if(domain.provenance, [&](const auto& known) {
    return is_place(known.first) && std::none_of(o.obstacles.begin(), o.obstacles.end(), [&](const auto& obstacle) {
             return known.first == place_fact({"obstacle " + obstacle.name, {{{0, 0}}}}).first;
           });
  });
  for (const SectionOptions& s : o.sections) {
    MapPlace place{"section " + s.name, {{}}};
    for (std::size_t i = 0; i < s.x.size(); ++i) place.rings[0].push_back({s.x[i], s.y[i]});
    domain.provenance.push_back(place_fact(place));
  }
  for (const GaugeOptions& g : o.gauges) domain.provenance.push_back(place_fact({"gauge " + g.name, {{{g.x, g.y}}}}));
}

/// This function refuses what is implausible in a scene, and adds what is insisted on to the facts of its results.
void judge(Domain& domain, const SolveOptions& o) {
  std::vector<std::string> before_the_run = o.accept;
  std::erase(before_the_run, torn_body);
  Acceptance acceptance("solve", before_the_run);
  acceptance.collect();
  judge_scene(plausibility_of(domain, make_scene(domain, o), o), o, acceptance);
  acceptance.settle();
  acceptance.warn_of_unmet();
  const auto& facts = acceptance.facts();
  domain.provenance.insert(domain.provenance.end(), facts.begin(), facts.end());
}

/// The run once more, twice as stiff, and the difference of the deposits as a share of the volume.
void check_stiffness(const Domain& domain, SolveOptions o, const AnyDevice& device, const StageContext& context,
                     const std::filesystem::path& first) {
  o.material.youngs_modulus *= 2;
  for (PartOptions& part : o.parts) part.material.youngs_modulus *= 2;
  log_info(fmt::format("stiffness check: once more with {:.3g} Pa", o.material.youngs_modulus));
  const auto folder = context.out / "stiffness-check";
  std::filesystem::create_directories(folder);
  const RunPaths paths(folder);
  Simulation(domain, o, device, paths, "").run(context.recipe.scene_name(), context.recipe.title());
  const Run soft = read_run(first), stiff = read_run(paths.run);
  double moved = 0, all = 0;
  for (std::size_t n = 0; n < soft.maps.deposit_thickness.size(); ++n) {
    const double a = soft.maps.deposit_thickness[n], b = stiff.maps.deposit_thickness[n];
    if (std::isfinite(a) && std::isfinite(b)) {
      moved += 0.5 * std::abs(a - b);
      all += b;
    }
  }
  log_info(fmt::format("stiffness check: {:.2f} % of the deposit lies elsewhere with {:.3g} Pa",
                       all > 0 ? 100 * moved / all : 0, o.material.youngs_modulus));
}

std::filesystem::path checkpoint_of(const SolveFlags& flags, const RunPaths& paths) {
  return flags.restart->empty() ? paths.checkpoint : *flags.restart;
}

/// What the command line says of an ensemble, and what it cannot say.
EnsembleFlags ensemble_flags(const SolveFlags& flags) {
  if (flags.profile)
    throw RecipeError({"--profile", "members of an ensemble run at a time, and share the processor",
                       "Profile one of them: leave --profile out, or run with --set ensemble.members=0"});
  if (flags.restart && !flags.restart->empty())
    throw RecipeError({"--restart " + flags.restart->string(), "an ensemble goes on from its own unfinished members",
                       "Write --restart alone"});
  return {.on = flags.on,
          .members = flags.members,
          .restart = flags.restart.has_value(),
          .resume = flags.resume,
          .plan = flags.plan};
}

Dependencies depends(const StageContext& context, const SolveFlags& flags) {
  if (ensemble_of(context.recipe).on()) return depends_of_ensemble(context, ensemble_flags(flags));
  const RunPaths paths(context.out);
  Dependencies depends{{paths.run}, inputs_of(options_of(context.recipe, context.out), context.out)};
  if (flags.restart) depends.inputs.push_back(checkpoint_of(flags, paths));
  if (const BudgetOptions budget = budget_of(context.recipe, flags.budget); budget.make)
    add_depends_of_budget(context, budget, depends);
  return depends;
}

/// This function goes on from a checkpoint where the flags ask for it. One of this very run that they do not ask for is
/// refused: hours of work would go without a word.
void take_up(Simulation& simulation, const SolveFlags& flags, const RunPaths& paths, const std::string& fingerprint) {
  if (flags.restart) return simulation.resume(checkpoint_of(flags, paths));
  if (!std::filesystem::exists(paths.checkpoint)) return;
  const auto head = look_at_checkpoint(paths.checkpoint);
  if (!head || head->fingerprint != fingerprint) {
    log_info(fmt::format("{}: {}; it stays until this run has one of its own, or is whole", paths.checkpoint.string(),
                         head ? "a checkpoint of another domain or other [solve] settings"
                              : "no checkpoint that this version can read"));
    return;
  }
  if (!flags.resume)
    throw DataError({fmt::format("{}: it holds this very run at t = {:.3f} s, step {}", paths.checkpoint.string(),
                                 head->time, head->step),
                     "a run from the start would throw it away",
                     "Go on from it with --restart, or remove it to begin anew"});
  try {
    simulation.resume(paths.checkpoint);
  } catch (const DataError& error) {
    log_warning(fmt::format("{} The run begins anew", error.what()));
  }
}

/// What of the command line a search for the factor of safety does not know.
void refuse_flags_of_runs(const SolveFlags& flags) {
  if (!flags.restart && !flags.profile) return;
  throw RecipeError({flags.restart ? "--restart" : "--profile",
                     "a search for the factor of safety takes no steps in time",
                     "Leave it out; a search that was broken off begins anew"});
}

/// What run.h5 says of a search beside its maps; `facts` are those of the outcome.
RunSummary summary_of_search(const StageContext& context, const SolveOptions& options, const AnyDevice& device,
                             const std::vector<Facts>& facts) {
  RunSummary summary;
  summary.scene = context.recipe.scene_name();
  summary.title = context.recipe.title();
  summary.on = device.is_gpu() ? gpu_name(device.gpu().index()) : hardware();
  summary.precision = "double";
  summary.version = version();
  summary.stop_reason = "factor of safety by strength reduction";
  summary.material = options.material.sentence();
  summary.bed = options.base.sentence();
  for (const Facts& some : facts) summary.provenance.insert(summary.provenance.end(), some.begin(), some.end());
  return summary;
}

/// This function finds the factor of safety in place of a run in time (T40), and writes run.h5 and stability.json.
/// `facts` are what is insisted on.
void find_stability(StageContext& context, const SolveOptions& options, const AnyDevice& device, const Domain& domain,
                    const Facts& facts) {
  StabilitySearch search(domain, options, device);
  log_info(
      fmt::format("factor of safety: {} material points; tan(friction) and cohesion are divided until no "
                  "equilibrium is left",
                  search.scene().points.size()));
  if (context.check_only) return;
  const auto begun = std::chrono::steady_clock::now();
  const Stability found = search.run();
  const CriticalMass mass = critical_mass(search.scene(), search.options(), found.failure);
  for (const std::string& line : stability_lines(found, mass)) log_info(line);
  for (const std::string& line : stability_warnings(found, mass)) log_warning(line);
  const Facts outcome = stability_facts(found, mass), id{{run_id, new_run_id()}};
  RunSummary summary =
      summary_of_search(context, options, device, {domain.provenance, id, made_by(context, options, facts), outcome});
  summary.wall_time = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  const auto run = RunPaths(context.out).run, json = context.out / "stability.json";
  write_stability_run(run, domain, search, mass, summary, device);
  write_text(json, stability_json(summary.scene, found, mass));
  context.results = {run, json};
  auto inputs = inputs_of(options, context.out);
  inputs.insert(inputs.begin(), context.recipe.file());
  Facts used{{"id", id.front().second}, {"on", summary.on}, {"wall_time_s", fmt::format("{:.3f}", summary.wall_time)}};
  used.insert(used.end(), outcome.begin(), outcome.end());
  write_used_recipe(context, stage(), recipe::to_used_toml(options, "solve"), inputs, used);
}

/// The options of a run as the recipe has them, and as they are settled for its scene.
struct RunOptions {
  SolveOptions asked, settled;
};

/// This function makes the run in time and writes its results. `facts` are what is insisted on.
void run_in_time(StageContext& context, const SolveFlags& flags, const RunOptions& run, const AnyDevice& device,
                 const Domain& domain, const Facts& facts) {
  const SolveOptions& options = run.settled;
  auto inputs = inputs_of(options, context.out);
  const std::string fingerprint = fingerprint_of(inputs.front(), options);
  inputs.insert(inputs.begin(), context.recipe.file());
  const RunPaths paths(context.out);
  if (flags.profile) device.profile().turn_on();
  Simulation simulation(domain, options, device, paths, fingerprint);
  if (context.check_only) return;
  take_up(simulation, flags, paths, fingerprint);
  const RunSummary summary =
      simulation.run(context.recipe.scene_name(), context.recipe.title(), made_by(context, options, facts));
  log_info(fmt::format("{} at t = {:.2f} s after {} steps in {:.1f} s", summary.stop_reason, summary.time_end,
                       summary.steps, summary.wall_time));
  if (flags.profile) report_profile(summary, device, context.out);
  if (options.material.stiffness_check) check_stiffness(domain, options, device, context, paths.run);
  context.results.push_back(paths.run);
  write_used_recipe(context, stage(), recipe::to_used_toml(run.asked, "solve"), inputs,
                    {{"id", fact(summary.provenance, run_id)},
                     {"on", summary.on},
                     {"wall_time_s", fmt::format("{:.3f}", summary.wall_time)},
                     {"steps", fmt::format("{}", summary.steps)},
                     {"stop_reason", summary.stop_reason}});
}

/// This function runs the members of the recipe's ensemble. `facts` are what is insisted on.
void run_members_of(StageContext& context, const SolveFlags& flags, const Domain& domain, const SolveOptions& options,
                    const AnyDevice& device, const Facts& facts) {
  if (options.stability.factor_of_safety)
    throw RecipeError({"[ensemble] with [solve.stability] factor_of_safety", "the search is no run in time",
                       "Leave one of them out"});
  EnsembleFlags ensemble = ensemble_flags(flags);
  ensemble.on = device.is_gpu() ? On::gpu : On::cpu;
  Facts used = run_ensemble(context, ensemble, domain, options, facts);
  if (used.empty()) return;
  used.emplace_back("on", device.is_gpu() ? gpu_name(device.gpu().index()) : hardware());
  auto inputs = inputs_of(options, context.out);
  inputs.insert(inputs.begin(), context.recipe.file());
  write_used_recipe(context, stage(), recipe::to_used_toml(options, "solve"), inputs, used);
}

/// This function refuses a budget of what is no single run in time.
void refuse_budget(const StageContext& context, const SolveFlags& flags, const SolveOptions& options) {
  const auto refuse = [](const std::string& what, const std::string& why) {
    throw RecipeError({"an error budget with " + what, why, "Leave one of them out"});
  };
  if (ensemble_of(context.recipe).on()) refuse("[ensemble]", "members of an ensemble say by themselves how far runs go");
  if (options.stability.factor_of_safety) refuse("factor_of_safety", "it varies runs in time, and the search is none");
  if (flags.profile) refuse("--profile", "its runs share the processor");
}

/// This function makes the run, unless run.h5 is of this recipe, domain and version already, and then the runs of its
/// budget.
void run_with_budget(StageContext& context, const SolveFlags& flags, const RunOptions& run, const BudgetBase& base,
                     const AnyDevice& device, const Domain& domain, const Facts& facts) {
  const BudgetOptions budget = budget_of(context.recipe, flags.budget);
  BudgetFlags how{.on = device.is_gpu() ? On::gpu : On::cpu, .restart = flags.restart.has_value(), .resume = flags.resume};
  if (context.check_only || !is_run_of(context, domain, RunPaths(context.out).run)) {
    run_in_time(context, flags, run, device, domain, facts);
    how.restart = false;  // the run itself went on, its budget begins
    if (context.check_only) return;
  } else {
    log_info(fmt::format("{}: it is this run already", RunPaths(context.out).run.string()));
    context.results.push_back(RunPaths(context.out).run);
  }
  run_budget(context, how, domain, base, budget, facts);
}

void solve(StageContext& context, const SolveFlags& flags) {
  auto options = options_of(context.recipe, context.out);
  const bool budgets = budget_of(context.recipe, flags.budget).make;
  if (budgets) refuse_budget(context, flags, options);
  const AnyDevice device = make_device(choose_device(flags.on));
  const auto domain_file = inputs_of(options, context.out).front();
  Domain domain = read_domain(domain_file);
  const Facts insisted = judge_inputs(context, options, domain_file, domain);
  if (ensemble_of(context.recipe).on()) return run_members_of(context, flags, domain, options, device, insisted);
  if (flags.members)
    throw RecipeError({"--members without an ensemble", "the recipe asks for one run",
                       "Leave it out, or add [ensemble] with members"});
  if (options.stability.factor_of_safety) {
    refuse_flags_of_runs(flags);
    context.check_only = context.check_only || flags.plan;
    find_stability(context, options, device, domain, insisted);
    return;
  }
  const SolveOptions asked = settle_stiffness(domain, options);
  const BudgetBase base{options, settle_steps(domain, asked)};
  options = base.settled;
  judge(domain, options);
  if (flags.plan) {
    for (const std::string& text : plan(domain, options, device)) log_info(text);
    const BudgetOptions budget = budget_of(context.recipe, flags.budget);
    if (budgets)
      for (const std::string& text : plan_of_budget(context, device.is_gpu() ? On::gpu : On::cpu, domain, base, budget))
        log_info(text);
    log_warnings(domain, options);
    return;
  }
  add_places(domain, options);
  log_plan(domain, options, device);
  log_warnings(domain, options);
  if (budgets) return run_with_budget(context, flags, {asked, options}, base, device, domain, insisted);
  run_in_time(context, flags, {asked, options}, device, domain, insisted);
}

}  // namespace

int main(int argc, char** argv) {
  SolveFlags given;
  Stage s = stage();
  s.flags = flags(given);
  s.depends = [&](const StageContext& context) { return depends(context, given); };
  s.used_toml = [&](const recipe::Recipe& recipe) { return used_tables(recipe, given.budget); };
  s.part = [&] { return given.members ? fmt::format("{}-{}", given.members->first, given.members->end) : ""; };
  s.run = [&](StageContext& context) {
    limit_threads_of_libraries(thread_limit());
    solve(context, given);
  };
  return run_stage(argc, argv, s);
}
