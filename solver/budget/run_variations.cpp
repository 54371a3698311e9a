// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/budget/run_variations.hpp"

#include <cstddef>
#include <mutex>
#include <string>
#include <utility>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/ensemble/side_by_side.hpp"

namespace talus::solver {
namespace {

/// The runs that wait, in order.
std::vector<std::size_t> waiting_in(const Budget& budget) {
  std::vector<std::size_t> waiting;
  for (std::size_t place = 0; place < budget.runs.size(); ++place)
    if (budget.runs[place].state == BudgetState::waiting) waiting.push_back(place);
  return waiting;
}

/// What the threads share: what came of the runs that have ended.
class Noting {
 public:
  Noting(const std::vector<Variation>& variations, Budget& budget, const BudgetPlan& plan)
      : variations_(variations), budget_(budget), plan_(plan) {}

  void make(std::size_t place, const AnyDevice& device) {
    BudgetRun run = budget_.runs[place];
    const Findings found("solve", {}, Findings::Log::kept_back);
    run.reason = failure_of([&] {
      const auto domain = domain_of(variations_[place], plan_.domain, plan_.paths);
      if (auto made = run_member(plan(domain, variations_[place].options, Settle::done), device))
        take(run, std::move(*made));
    });
    if (!run.reason.empty()) run.state = BudgetState::failed;
    if (run.state == BudgetState::waiting) return;
    for (const Finding& f : found.list())
      if (f.severity == Severity::refusal)
        run.accepted.emplace_back("accepted." + f.name, f.message);
      else
        run.warnings.push_back(f.message);
    put(place, std::move(run));
  }

 private:
  static void take(BudgetRun& run, MemberRun&& made) {
    if (made.result.volume_outflow > 0)
      warn("volume-left-domain",
           fmt::format("{:.4g} m3 left the domain, and are missing from its maps. Take a larger domain",
                       made.result.volume_outflow));
    run.state = BudgetState::done;
    run.result = made.result;
    run.deposit = {made.maps.grid, std::move(made.maps.deposit_thickness)};
    run.peak_thickness = {made.maps.grid, std::move(made.maps.peak_thickness)};
  }

  void put(std::size_t place, BudgetRun&& run) {
    const std::lock_guard<std::mutex> one(mutex_);
    budget_.runs[place] = std::move(run);
    const std::size_t left = budget_.count(BudgetState::waiting);
    if (progress_.due()) progress_.update(fmt::format("budget: {} ended, {} to go", budget_.runs[place].name, left));
    if (plan_.save && left > 0) plan_.save();
  }

  const std::vector<Variation>& variations_;
  Budget& budget_;
  const BudgetPlan& plan_;
  std::mutex mutex_;
  Progress progress_;
};

}  // namespace

std::shared_ptr<const Domain> domain_of(const Variation& variation, const std::shared_ptr<const Domain>& base,
                                        const BudgetPaths& paths) {
  if (variation.run.domain.empty() && !variation.change_bed) return base;
  Domain domain = variation.run.domain.empty() ? *base : read_domain(paths.domain(variation.run.domain));
  if (variation.change_bed) domain = with_bed(std::move(domain), variation.change_bed);
  return std::make_shared<const Domain>(std::move(domain));
}

bool run_variations(const std::vector<Variation>& variations, Budget& budget, const BudgetPlan& plan) {
  const std::vector<std::size_t> waiting = waiting_in(budget);
  Noting noting(variations, budget, plan);
  side_by_side(waiting.size(), plan.devices,
               [&](std::size_t place, const AnyDevice& device) { noting.make(waiting[place], device); });
  for (const std::size_t place : waiting) {
    const BudgetRun& run = budget.runs[place];
    for (const auto& [name, words] : run.accepted) log_warning(fmt::format("{}: {}: {}", run.name, name, words));
    for (const std::string& words : run.warnings) log_warning(fmt::format("{}: {}", run.name, words));
  }
  return budget.count(BudgetState::waiting) == 0;
}

}  // namespace talus::solver
