// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/budget/budget_stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "common/domain/domain_facts.hpp"
#include "common/run/run_facts.hpp"
#include "common/run/sealed_file.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/interrupt.hpp"
#include "solver/budget/own_changes.hpp"
#include "solver/budget/run_variations.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/member_cost.hpp"
#include "solver/plan/named_places.hpp"
#include "solver/plan/plan.hpp"
#include "solver/plan/trial.hpp"
#include "solver/run/run_inputs.hpp"
#include "solver/run/simulation.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

namespace fs = std::filesystem;

/// Why talus-preprocess could not make a domain; empty where it says nothing.
std::string why_not_made(const BudgetPaths& paths, const std::string& name) {
  std::istringstream told(text_if_there(paths.domains()).value_or(""));
  const std::string mark = name + ": left out: ";
  for (std::string line; std::getline(told, line);)
    if (line.starts_with(mark)) return line.substr(mark.size());
  return "";
}

/// Leaves a variation out whose domain is missing or is beside another one than the run's.
void find_domain(Variation& one, const BudgetPaths& paths, const Domain& base) {
  if (one.run.domain.empty()) return;
  const fs::path file = paths.domain(one.run.domain);
  const auto leave_out = [&](const std::string& why) {
    one.run.state = BudgetState::left_out;
    one.run.reason = fmt::format("{} {}; talus-preprocess --budget makes it", file.string(), why);
  };
  if (const std::string why = why_not_made(paths, one.run.domain); !why.empty() && !fs::exists(file)) {
    one.run.state = BudgetState::left_out;
    one.run.reason = why;
    return;
  }
  if (!fs::exists(file)) return leave_out("is missing");
  const Facts facts = domain_facts(file);
  if (fact(facts, budget_base) != fact(base.provenance, domain_id))
    return leave_out("was made beside another domain than the run's");
  std::istringstream values(fact(facts, budget_values));
  for (std::string value; std::getline(values, value);) one.run.values.push_back(value);
}

/// What a budget is made of, once it is read.
struct BudgetScene {
  std::shared_ptr<const Domain> domain;  ///< of the run itself
  BudgetBase base;                       ///< likewise
  std::vector<Variation> variations;     ///< those without a domain left out
};

BudgetScene read_budget_scene(const StageContext& context, const BudgetOptions& options) {
  BudgetScene scene;
  scene.base.asked = options_of(context.recipe, context.out);
  const fs::path file = inputs_of(scene.base.asked, context.out).front();
  scene.domain = std::make_shared<const Domain>(read_domain(file));
  const Findings found("solve", {}, Findings::Log::kept_back);  // the run itself has said all of it
  judge_inputs(context, scene.base.asked, file, *scene.domain);
  scene.base.places = scene.domain->places;
  scene.base.asked = with_places(std::move(scene.base.asked), scene.base.places);
  Plan base = begin_plan(scene.domain, scene.base.asked);
  settle(base);
  scene.base.settled = std::move(base.options);
  scene.variations = variations_of(*scene.domain, scene.base, options);
  for (Variation& one : own_changes(context.recipe, context.out, scene.base, options))
    scene.variations.push_back(std::move(one));
  for (Variation& one : scene.variations)
    if (one.run.state == BudgetState::waiting) find_domain(one, {context.out}, *scene.domain);
  return scene;
}

std::string budget_fingerprint(const StageContext& context, const BudgetScene& scene, const BudgetOptions& options) {
  std::string text = fingerprint_of(inputs_of(scene.base.settled, context.out).front(), scene.base.settled);
  BudgetOptions made = options;
  made.make = true;  // by the recipe or by --budget
  text += recipe::to_toml(made, "budget", false);
  for (const Variation& one : scene.variations) {
    text += one.run.name + (one.run.state == BudgetState::left_out ? " left out\n" : "\n");
    if (one.run.state == BudgetState::waiting && !one.run.domain.empty())
      text += fact(domain_facts(BudgetPaths{context.out}.domain(one.run.domain)), domain_id) + "\n";
  }
  return sha256_of_text(text);
}

Budget fresh_budget(const StageContext& context, const BudgetScene& scene, const BudgetOptions& options) {
  Budget budget{.fingerprint = budget_fingerprint(context, scene, options),
                .run = fact(run_facts(RunPaths(context.out).run), run_id),
                .options = recipe::to_toml(options, "budget", false),
                .runs = {},
                .provenance = scene.domain->provenance};
  for (const Variation& one : scene.variations) budget.runs.push_back(one.run);
  const Facts own = made_by(context, scene.base.settled);
  budget.provenance.insert(budget.provenance.end(), own.begin(), own.end());
  budget.provenance.emplace_back("version.solve", version());
  return budget;
}

/// What is finished of this very budget, none where nothing is.
std::optional<Budget> finished_of(const fs::path& file, const Budget& budget) {
  if (!fs::exists(file)) return std::nullopt;
  Budget found = read_budget(file);
  if (found.fingerprint != budget.fingerprint || found.run != budget.run) return std::nullopt;
  return found;
}

/// This function takes up what an interrupted computation of this budget has finished, as the flags ask for.
void take_up_budget(const fs::path& file, const BudgetFlags& flags, Budget& budget) {
  auto found = finished_of(file, budget);
  if (!found) {
    if (flags.restart)
      throw DataError({file.string() + (fs::exists(file) ? ": of another budget" : ": no such file"),
                       "the run itself is whole, and there is nothing of its budget to go on from",
                       "Leave --restart out"});
    return;
  }
  const std::size_t done = found->runs.size() - found->count(BudgetState::waiting);
  if (!flags.restart && !flags.resume)
    throw DataError({fmt::format("{}: it holds {} finished runs of this very budget", file.string(), done),
                     "a start from the beginning would throw them away",
                     "Go on from it with --restart, or remove it to begin anew"});
  log_info(fmt::format("going on from {}: {} of {} runs are finished", file.string(), done, found->runs.size()));
  budget = std::move(*found);
}

/// How many of the runs are made at a time: by the memory of the largest.
InFlight budget_flight(const BudgetScene& scene, const BudgetOptions& options, const BudgetFlags& flags,
                       std::size_t runs) {
  const std::vector<AnyDevice> each = one_of_each(flags.on);
  const MemberCost cost =
      cost_of_member(draft_plan(scene.domain, scene.base.settled, Settle::done), each.front(), false);
  const double finer = std::max(1.0, std::pow(options.cell_factor, -3.0));
  return in_flight(static_cast<std::int64_t>(std::max<std::size_t>(runs, 1)), flags.at_a_time, finer * cost.bytes,
                   each);
}

/// This function says what failed and what is left out; it throws where nothing is left to compare.
void judge_budget(const Budget& budget) {
  for (const BudgetRun& run : budget.runs) {
    if (run.state == BudgetState::left_out) log_info(fmt::format("budget: {} is left out: {}", run.name, run.reason));
    if (run.state == BudgetState::failed)
      warn("budget-run-failed", fmt::format("budget: {} failed: {}", run.name, run.reason));
  }
  if (budget.count(BudgetState::done) > 0 || budget.runs.empty()) return;
  throw NumericalError({"no run of the error budget came to its end",
                        "there is nothing to compare the run with; the lines above say why",
                        "Mend what makes them fail, or take other doubts in [budget]"});
}

/// This function warns of what the recipe accepts and neither the run nor its budget met.
void say_unmet(const StageContext& context, const BudgetScene& scene, const Budget& budget) {
  std::vector<Finding> met = read_run(RunPaths(context.out).run).summary.findings;
  for (const BudgetRun& run : budget.runs)
    for (const auto& [name, words] : run.accepted)
      met.push_back({Severity::refusal, name.substr(std::string("accepted.").size()), words});
  warn_of_unused("solve", scene.base.asked.accept, met);
}

/// This function says the price: the runs, what each takes, what is left out and why.
void say_price(const StageContext& context, const BudgetScene& scene, const BudgetOptions& options,
               const BudgetFlags& flags) {
  const AnyDevice device = make_device(flags.on);
  std::vector<std::string> lines;
  double least = 0, most = 0;
  std::size_t runs = 0;
  for (const Variation& one : scene.variations) {
    if (one.run.state == BudgetState::left_out) {
      lines.push_back(fmt::format("  {:<14} left out: {}", one.run.name, one.run.reason));
      continue;
    }
    stop_if_interrupted("trying the runs of the budget");
    const Plan draft = draft_plan(domain_of(one, scene.domain, {context.out}), one.options, Settle::done);
    const MemberCost cost = cost_of_member(draft, device, true);
    const double fewest = cost.fewest_steps * cost.step_seconds, all = cost.most_steps * cost.step_seconds;
    lines.push_back(
        fmt::format("  {:<14} {} to {}: {}", one.run.name, time_words(fewest), time_words(all), one.run.words));
    least += fewest;
    most += all;
    ++runs;
  }
  const InFlight flight = budget_flight(scene, options, flags, runs);
  log_info(fmt::format("{:<12} {} runs beside the run itself, {} at a time ({}): {} to {} in all", "budget", runs,
                       flight.count, flight.reason, time_words(least / flight.count), time_words(most / flight.count)));
  for (const std::string& line : lines) log_info(line);
}

/// This function makes the runs of a budget that wait. It throws Interrupted where they could not all be made.
void make_runs(const StageContext& context, const BudgetFlags& flags, const BudgetScene& scene,
               const BudgetOptions& options, Budget& budget) {
  const BudgetPaths paths{context.out};
  const std::size_t waiting = budget.count(BudgetState::waiting);
  const InFlight flight = budget_flight(scene, options, flags, waiting);
  log_info(
      fmt::format("budget: {} runs beside the run itself, {} at a time: {}", waiting, flight.count, flight.reason));
  const OwnEnd saving("finished runs of the budget are saved");
  const auto save = [&] { write_budget(paths.unfinished(), budget); };
  if (run_variations(scene.variations, budget, {scene.domain, paths, devices_for(flight.count, flags.on), save}))
    return;
  save();
  throw Interrupted({fmt::format("stopped with {} of {} runs of the budget finished",
                                 budget.runs.size() - budget.count(BudgetState::waiting), budget.runs.size()),
                     "interrupted", fmt::format("Go on with --restart; {} holds them", paths.unfinished().string())});
}

}  // namespace

void refuse_budget(const StageContext& context, const SolveOptions& options, const RunFlags& flags) {
  const auto refuse = [](const std::string& what, const std::string& why) {
    throw RecipeError({"an error budget with " + what, why, "Leave one of them out"});
  };
  if (ensemble_of(context.recipe).on())
    refuse("[ensemble]", "the members of an ensemble say by themselves how far runs go");
  if (options.stability.factor_of_safety) refuse("factor_of_safety", "it varies runs in time, and the search is none");
  if (flags.profile) refuse("--profile", "its runs share the processor");
}

bool is_this_run(StageContext& context) {
  const fs::path file = RunPaths(context.out).run;
  if (!fs::exists(file)) return false;
  const SolveOptions options = options_of(context.recipe, context.out);
  const h5::File run = h5::open_sealed(file, {file, "Remove it, and run talus-solve again"});
  const Facts facts = run_facts(run);
  const std::string domain = fact(domain_facts(inputs_of(options, context.out).front()), domain_id);
  if (fact(facts, recipe_of_run) != recipe_mark(context.recipe, "solve") || fact(facts, domain_id) != domain ||
      run.text("/", "version") != version())
    return false;
  log_info(fmt::format("{}: it is this run already", file.string()));
  context.results.push_back(file);
  return true;
}

void add_depends_of_budget(const StageContext& context, const BudgetOptions& budget, Dependencies& depends) {
  const BudgetPaths paths{context.out};
  depends.results.insert(depends.results.begin(), paths.budget());
  std::vector<std::string> names;
  if (budget.has("cells")) names.emplace_back("cells");
  for (int draw = 1; draw <= budget.survey_draws && budget.has("survey"); ++draw)
    names.push_back(survey_draw_name(draw));
  for (const std::string& name : names)
    if (fs::exists(paths.domain(name))) depends.inputs.push_back(paths.domain(name));
}

void run_budget(StageContext& context, const BudgetFlags& flags, const BudgetOptions& options) {
  const auto begun = std::chrono::steady_clock::now();
  const BudgetPaths paths{context.out};
  const BudgetScene scene = read_budget_scene(context, options);
  if (flags.plan) return say_price(context, scene, options, flags);
  if (context.check_only) return;
  Budget budget = fresh_budget(context, scene, options);
  context.results.push_back(paths.budget());
  if (finished_of(paths.budget(), budget)) {
    log_info(fmt::format("{}: it holds this very budget already", paths.budget().string()));
    return;
  }
  take_up_budget(paths.unfinished(), flags, budget);
  make_runs(context, flags, scene, options, budget);
  judge_budget(budget);
  say_unmet(context, scene, budget);
  write_budget(paths.budget(), budget);
  remove_for_good(paths.unfinished());
  log_info(fmt::format("budget: {} runs done, {} failed, {} left out, in {:.1f} s; talus-postprocess compares them",
                       budget.count(BudgetState::done), budget.count(BudgetState::failed),
                       budget.count(BudgetState::left_out),
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count()));
}

}  // namespace talus::solver
