// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/budget/run_variations.hpp"

#include <cstddef>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "common/stage/console.hpp"
#include "common/stage/stage.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/parallel/alone.hpp"

namespace talus::solver {
namespace {

/// The work that the threads share: which run is next, what came of those that have ended.
class BudgetQueue {
 public:
  BudgetQueue(const std::vector<Variation>& variations, Budget& budget, const BudgetPlan& plan)
      : variations_(variations), budget_(budget), plan_(plan) {}

  /// The next run that waits; none where all are taken, the process is interrupted, or a thread has failed.
  std::optional<std::size_t> next() {
    const std::lock_guard<std::mutex> one(mutex_);
    while (next_ < variations_.size() && budget_.runs[next_].state != BudgetState::waiting) ++next_;
    if (interrupted() || failure_ || next_ == variations_.size()) return std::nullopt;
    return next_++;
  }

  void make(std::size_t place, const AnyDevice& device) {
    BudgetRun run = budget_.runs[place];
    const QuietThread quiet;
    run.reason = failure_of([&] {
      const Domain domain = domain_of(variations_[place], plan_.domain, plan_.paths);
      if (auto made = run_member(domain, variations_[place].options, device)) take(run, std::move(*made));
    });
    if (!run.reason.empty()) run.state = BudgetState::failed;
    if (run.state != BudgetState::waiting) put(place, std::move(run), quiet.warnings());
  }

  void note_failure(std::exception_ptr failure) {
    const std::lock_guard<std::mutex> one(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }

  /// Whether no run waits any more, once the threads have ended. Throws what a thread threw.
  bool whole() const {
    if (failure_) std::rethrow_exception(failure_);
    return budget_.count(BudgetState::waiting) == 0;
  }

  /// What the runs warned of.
  const std::vector<std::string>& warnings() const { return warnings_; }

 private:
  static void take(BudgetRun& run, MemberRun&& made) {
    run.state = BudgetState::done;
    run.result = made.result;
    run.deposit = {made.maps.grid, std::move(made.maps.deposit_thickness)};
    run.peak_thickness = {made.maps.grid, std::move(made.maps.peak_thickness)};
  }

  void put(std::size_t place, BudgetRun&& run, const std::vector<std::string>& warnings) {
    const std::lock_guard<std::mutex> one(mutex_);
    for (const std::string& words : warnings) warnings_.push_back(fmt::format("{}: {}", run.name, words));
    budget_.runs[place] = std::move(run);
    const std::size_t left = budget_.count(BudgetState::waiting);
    if (progress_.due()) progress_.update(fmt::format("budget: {} ended, {} to go", budget_.runs[place].name, left));
    if (plan_.save && left > 0) plan_.save();
  }

  const std::vector<Variation>& variations_;
  Budget& budget_;
  const BudgetPlan& plan_;
  std::mutex mutex_;
  std::size_t next_ = 0;
  std::exception_ptr failure_;
  std::vector<std::string> warnings_;
  Progress progress_;
};

}  // namespace

Domain domain_of(const Variation& variation, const Domain& base, const BudgetPaths& paths) {
  Domain domain = variation.run.domain.empty() ? base : read_domain(paths.domain(variation.run.domain));
  return variation.change_bed ? with_bed(std::move(domain), variation.change_bed) : domain;
}

bool run_variations(const std::vector<Variation>& variations, Budget& budget, const BudgetPlan& plan) {
  BudgetQueue queue(variations, budget, plan);
  const auto work = [&](const AnyDevice& device) {
    const Alone alone;
    try {
      while (const auto place = queue.next()) queue.make(*place, device);
    } catch (...) {
      queue.note_failure(std::current_exception());
    }
  };
  std::vector<std::thread> threads;
  for (const AnyDevice& device : plan.devices) threads.emplace_back(work, std::cref(device));
  for (std::thread& thread : threads) thread.join();
  const bool whole = queue.whole();
  for (const std::string& words : queue.warnings()) log_warning(words);
  return whole;
}

}  // namespace talus::solver
