// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/run_members.hpp"

#include <algorithm>
#include <chrono>
#include <mutex>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/ensemble/side_by_side.hpp"

namespace talus::solver {
namespace {

using WallClock = std::chrono::steady_clock;

/// What a killed process may lose [s]. What is finished is saved after the first member, so that a folder that takes
/// no files shows at once, and then so often: writing the counts of a large map takes seconds.
constexpr double save_interval = 60;

double seconds_since(WallClock::time_point begun) {
  return std::chrono::duration<double>(WallClock::now() - begun).count();
}

/// What a member's run came to: maps and numbers, or why it failed; neither where it was given up.
struct Outcome {
  std::optional<MemberRun> run;
  std::string failure;
  std::vector<Finding> findings;
};

constexpr const char* at_the_edge =
    "it came to the edge of its domain, and what lies beyond is not known ([slides] at_edge = \"fail\"). Give a larger "
    "margin_m, or a smaller reach_angle_deg";

Outcome outcome_of(const Members& members, std::int64_t member, const AnyDevice& device, bool edge_fails) {
  const Findings found("solve", {}, Findings::Log::kept_back);
  Outcome outcome;
  outcome.failure = failure_of([&] { outcome.run = run_member(members.plan(member), device); });
  if (edge_fails && outcome.run && is_at_edge(outcome.run->result)) {
    outcome.run.reset();
    outcome.failure = at_the_edge;
  }
  outcome.findings = found.list();
  return outcome;
}

/// The members that wait, in order.
std::vector<std::int64_t> waiting_in(const EnsembleCounts& counts) {
  std::vector<std::int64_t> waiting;
  for (std::int64_t k = counts.part.first; k < counts.part.end; ++k)
    if (counts.states[static_cast<std::size_t>(k - counts.part.first)] == MemberState::waiting) waiting.push_back(k);
  return waiting;
}

/// What the threads share: the counts, and what is said.
class Tallying {
 public:
  Tallying(EnsembleCounts& counts, std::size_t members, const MembersPlan& plan)
      : counts_(counts), members_(members), plan_(plan) {}

  void count(std::int64_t member, Outcome&& outcome) {
    const std::lock_guard<std::mutex> one(mutex_);
    if (outcome.run) {
      counts_.add(member, outcome.run->maps, outcome.run->result);
    } else if (!outcome.failure.empty()) {
      counts_.fail(member, std::move(outcome.failure));
    } else {
      return;  // given up
    }
    for (Finding& finding : outcome.findings) counts_.add_finding(member, std::move(finding));
    ++done_;
    say();
    save();
  }

  /// Whether all members have ended.
  bool is_whole() const { return done_ == members_; }

 private:
  void say() {
    if (!progress_.due()) return;
    const double wall = seconds_since(begun_),
                 left = wall / static_cast<double>(done_) * static_cast<double>(members_ - done_);
    const std::int64_t failed = counts_.count(MemberState::failed);
    progress_.update(fmt::format("member {}/{}  {:.2g} s each  eta {:.0f} s{}", done_, members_,
                                 wall / static_cast<double>(done_), left,
                                 failed > 0 ? fmt::format("  {} failed", failed) : ""));
  }

  void save() {
    if (!plan_.save || (saved_ && seconds_since(*saved_) < save_interval) || done_ == members_) return;
    plan_.save();
    saved_ = WallClock::now();
  }

  EnsembleCounts& counts_;
  std::size_t members_, done_ = 0;
  const MembersPlan& plan_;
  std::mutex mutex_;
  Progress progress_;
  WallClock::time_point begun_ = WallClock::now();
  std::optional<WallClock::time_point> saved_;
};

}  // namespace

bool run_members(const Members& members, EnsembleCounts& counts, const MembersPlan& plan) {
  const std::vector<std::int64_t> waiting = waiting_in(counts);
  Tallying tallying(counts, waiting.size(), plan);
  side_by_side(waiting.size(), plan.devices, [&](std::size_t place, const AnyDevice& device) {
    tallying.count(waiting[place], outcome_of(members, waiting[place], device, plan.edge_fails));
  });
  return tallying.is_whole();
}

}  // namespace talus::solver
