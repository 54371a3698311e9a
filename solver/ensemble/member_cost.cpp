// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/member_cost.hpp"

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/parallel/alone.hpp"
#include "solver/plan/trial.hpp"

namespace talus::solver {
namespace {

constexpr double trial_seconds = 0.5;

}  // namespace

MemberCost cost_of_member(const Plan& base, const AnyDevice& device, bool timed) {
  const Findings found("solve", {}, Findings::Log::kept_back);
  const Alone alone;
  const Trial trial = try_steps(base, device, timed ? trial_seconds : 0);
  const StepCount count = count_steps(base, trial.step);
  return {.bytes = static_cast<double>(trial.bytes),
          .step_seconds = trial.seconds,
          .fewest_steps = count.fewest,
          .most_steps = count.most};
}

std::vector<std::string> lines_of(const MemberCost& cost, std::int64_t count, int in_flight) {
  std::vector<std::string> lines{fmt::format("{:<12} {:.1f} MB for each member now", "memory", cost.bytes / 1e6)};
  if (!(cost.step_seconds > 0)) return lines;
  const double rounds = static_cast<double>(count) / in_flight;
  lines.push_back(
      fmt::format("{:<12} {} to {} at {:.3g} ms a step of a member by itself; members that run at a time "
                  "share caches, memory and a GPU",
                  "time", time_words(rounds * cost.fewest_steps * cost.step_seconds),
                  time_words(rounds * cost.most_steps * cost.step_seconds), 1e3 * cost.step_seconds));
  return lines;
}

}  // namespace talus::solver
