// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/budget/budget_stage.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <optional>
#include <sstream>
#include <utility>

#include <fmt/format.h>

#include "common/domain/domain_facts.hpp"
#include "common/run/run_facts.hpp"
#include "common/run/trusted_file.hpp"
#include "common/stage/interrupt.hpp"
#include "solver/budget/run_variations.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/ensemble/member_cost.hpp"
#include "solver/run/run_inputs.hpp"
#include "solver/run/simulation.hpp"
#include "solver/run/trial.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

namespace fs = std::filesystem;

/// Why talus-preprocess could not make a domain; empty where it says nothing.
std::string why_not_made(const BudgetPaths& paths, const std::string& name) {
  std::ifstream told(paths.domains());
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

/// The variations of the scene, those without a domain left out.
std::vector<Variation> found_variations(const StageContext& context, const Domain& domain, const BudgetBase& base,
                                        const BudgetOptions& options) {
  std::vector<Variation> variations = variations_of(domain, base, options);
  for (Variation& one : variations)
    if (one.run.state == BudgetState::waiting) find_domain(one, {context.out}, domain);
  return variations;
}

std::string budget_fingerprint(const StageContext& context, const BudgetBase& base, const BudgetOptions& options,
                               const std::vector<Variation>& variations) {
  std::string text = fingerprint_of(inputs_of(base.settled, context.out).front(), base.settled);
  BudgetOptions made = options;
  made.make = true;  // by the recipe or by --budget
  text += recipe::to_toml(made, "budget", false);
  for (const Variation& one : variations) {
    text += one.run.name + (one.run.state == BudgetState::left_out ? " left out\n" : "\n");
    if (one.run.state == BudgetState::waiting && !one.run.domain.empty())
      text += fact(domain_facts(BudgetPaths{context.out}.domain(one.run.domain)), domain_id) + "\n";
  }
  return sha256_of_text(text);
}

Budget fresh_budget(const StageContext& context, const Domain& domain, const BudgetBase& base,
                    const BudgetOptions& options, const std::vector<Variation>& variations) {
  Budget budget{.fingerprint = budget_fingerprint(context, base, options, variations),
                .run = fact(run_facts(RunPaths(context.out).run), run_id),
                .options = recipe::to_toml(options, "budget", false),
                .runs = {},
                .provenance = domain.provenance};
  for (const Variation& one : variations) budget.runs.push_back(one.run);
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

std::vector<AnyDevice> budget_devices(int count, On on) {
  std::vector<AnyDevice> devices;
  const int gpus = on == On::gpu ? GpuDevice::count() : 1;
  for (int k = 0; k < count; ++k) devices.push_back(make_device(on, k % gpus));
  return devices;
}

/// How many of the runs are made at a time: by the memory of the largest.
InFlight budget_flight(const Domain& domain, const BudgetBase& base, const BudgetOptions& options, On on,
                       std::size_t runs) {
  const std::vector<AnyDevice> each = budget_devices(on == On::gpu ? GpuDevice::count() : 1, on);
  const MemberCost cost = cost_of_member(domain, base.settled, each.front(), false);
  const double finer = std::max(1.0, std::pow(options.cell_factor, -3.0));
  return in_flight(static_cast<std::int64_t>(std::max<std::size_t>(runs, 1)), finer * cost.bytes, each);
}

/// This function says what failed and what is left out; it throws where nothing is left to compare.
void judge_budget(const Budget& budget) {
  for (const BudgetRun& run : budget.runs) {
    if (run.state == BudgetState::left_out) log_info(fmt::format("budget: {} is left out: {}", run.name, run.reason));
    if (run.state == BudgetState::failed) log_warning(fmt::format("budget: {} failed: {}", run.name, run.reason));
  }
  if (budget.count(BudgetState::done) > 0 || budget.runs.empty()) return;
  throw NumericalError({"no run of the error budget came to its end",
                        "there is nothing to compare the run with; the lines above say why",
                        "Mend what makes them fail, or take other doubts in [budget]"});
}

}  // namespace

bool is_run_of(const StageContext& context, const Domain& domain, const fs::path& file) {
  if (!fs::exists(file)) return false;
  const h5::TrustedFile run = h5::open_trusted(file, {file, "Remove it, and run talus-solve again"});
  const Facts facts = run_facts(run.file);
  return fact(facts, recipe_of_run) == recipe_mark(context.recipe, "solve") &&
         fact(facts, domain_id) == fact(domain.provenance, domain_id) && run.file.text("/", "version") == version();
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

std::vector<std::string> plan_of_budget(const StageContext& context, On on, const Domain& domain,
                                        const BudgetBase& base, const BudgetOptions& options) {
  const std::vector<Variation> variations = found_variations(context, domain, base, options);
  const AnyDevice device = make_device(on);
  std::vector<std::string> lines;
  double least = 0, most = 0;
  std::size_t runs = 0;
  for (const Variation& one : variations) {
    if (one.run.state == BudgetState::left_out) {
      lines.push_back(fmt::format("  {:<14} left out: {}", one.run.name, one.run.reason));
      continue;
    }
    const MemberCost cost = cost_of_member(domain_of(one, domain, {context.out}), one.options, device, true);
    const double fewest = cost.fewest_steps * cost.step_seconds, all = cost.most_steps * cost.step_seconds;
    lines.push_back(
        fmt::format("  {:<14} {} to {}: {}", one.run.name, time_words(fewest), time_words(all), one.run.words));
    least += fewest;
    most += all;
    ++runs;
  }
  const InFlight flight = budget_flight(domain, base, options, on, runs);
  lines.insert(lines.begin(),
               fmt::format("{:<12} {} runs beside the run itself, {} at a time ({}): {} to {} in all", "budget", runs,
                           flight.count, flight.reason, time_words(least / flight.count),
                           time_words(most / flight.count)));
  return lines;
}

void run_budget(StageContext& context, const BudgetFlags& flags, const Domain& domain, const BudgetBase& base,
                const BudgetOptions& options, const Facts& facts) {
  const auto begun = std::chrono::steady_clock::now();
  const BudgetPaths paths{context.out};
  const std::vector<Variation> variations = found_variations(context, domain, base, options);
  Budget budget = fresh_budget(context, domain, base, options, variations);
  const Facts own = made_by(context, base.settled, facts);
  budget.provenance.insert(budget.provenance.end(), own.begin(), own.end());
  budget.provenance.emplace_back("version.solve", version());
  if (finished_of(paths.budget(), budget)) {
    log_info(fmt::format("{}: it holds this very budget already", paths.budget().string()));
    context.results.push_back(paths.budget());
    return;
  }
  take_up_budget(paths.unfinished(), flags, budget);
  const std::size_t waiting = budget.count(BudgetState::waiting);
  const InFlight flight = budget_flight(domain, base, options, flags.on, waiting);
  log_info(fmt::format("budget: {} runs beside the run itself, {} at a time: {}", waiting, flight.count,
                       flight.reason));
  const OwnEnd saving("finished runs of the budget are saved");
  const auto save = [&] { write_budget(paths.unfinished(), budget); };
  if (!run_variations(variations, budget, {domain, paths, budget_devices(flight.count, flags.on), save})) {
    save();
    throw Interrupted({fmt::format("stopped with {} of {} runs of the budget finished",
                                   budget.runs.size() - budget.count(BudgetState::waiting), budget.runs.size()),
                       "interrupted", fmt::format("Go on with --restart; {} holds them", paths.unfinished().string())});
  }
  judge_budget(budget);
  write_budget(paths.budget(), budget);
  remove_for_good(paths.unfinished());
  context.results.push_back(paths.budget());
  log_info(fmt::format("budget: {} runs done, {} failed, {} left out, in {:.1f} s; talus-postprocess compares them",
                       budget.count(BudgetState::done), budget.count(BudgetState::failed),
                       budget.count(BudgetState::left_out),
                       std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count()));
}

}  // namespace talus::solver
