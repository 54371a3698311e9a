// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/run_members.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include "common/stage/console.hpp"
#include "common/stage/stage.hpp"
#include "solver/ensemble/member_run.hpp"
#include "solver/parallel/alone.hpp"

namespace talus::solver {
namespace {

using WallClock = std::chrono::steady_clock;

double seconds_since(WallClock::time_point begun) {
  return std::chrono::duration<double>(WallClock::now() - begun).count();
}

/// What a member's run came to: maps and numbers, or why it failed; neither where it was given up.
struct Outcome {
  std::optional<MemberRun> run;
  std::string failure;
  std::vector<std::string> warnings;
};

constexpr const char* at_the_edge =
    "it came to the edge of its domain, and what lies beyond is not known ([slides] at_edge = \"fail\"). Give a larger "
    "margin_m, or a smaller reach_angle_deg";

Outcome outcome_of(const Members& members, std::int64_t member, const AnyDevice& device, bool edge_fails) {
  const QuietThread quiet;
  Outcome outcome;
  outcome.failure = failure_of([&] {
    const Member own = members.read(member);
    outcome.run = run_member(own.domain, own.options, device);
  });
  if (edge_fails && outcome.run && is_at_edge(outcome.run->result)) {
    outcome.run.reset();
    outcome.failure = at_the_edge;
  }
  outcome.warnings = quiet.warnings();
  return outcome;
}

/// The work that the threads share: which member is next, the counts, what is said.
class Queue {
 public:
  Queue(EnsembleCounts& counts, const MembersPlan& plan) : counts_(counts), plan_(plan) {
    for (std::int64_t k = counts.part.first; k < counts.part.end; ++k)
      if (counts.states[static_cast<std::size_t>(k - counts.part.first)] == MemberState::waiting) waiting_.push_back(k);
  }

  /// The next member; none where all are taken, the process is interrupted, or a thread has failed.
  std::optional<std::int64_t> next() {
    const std::lock_guard<std::mutex> one(mutex_);
    if (interrupted() || failure_ || taken_ == waiting_.size()) return std::nullopt;
    return waiting_[taken_++];
  }

  void count(std::int64_t member, Outcome&& outcome) {
    const std::lock_guard<std::mutex> one(mutex_);
    for (std::string& words : outcome.warnings) run_.warnings.push_back({member, std::move(words)});
    if (outcome.run) {
      counts_.add(member, outcome.run->maps, outcome.run->result);
    } else if (!outcome.failure.empty()) {
      counts_.fail(member, std::move(outcome.failure));
    } else {
      return;  // given up
    }
    ++done_;
    say();
    save();
  }

  void note_failure(std::exception_ptr failure) {
    const std::lock_guard<std::mutex> one(mutex_);
    if (!failure_) failure_ = std::move(failure);
  }

  /// What the threads came to, once all have ended. Throws what a thread threw.
  MembersRun result() {
    if (failure_) std::rethrow_exception(failure_);
    run_.whole = done_ == waiting_.size();
    std::stable_sort(run_.warnings.begin(), run_.warnings.end(),
                     [](const MemberWarning& a, const MemberWarning& b) { return a.member < b.member; });
    return std::move(run_);
  }

 private:
  void say() {
    if (!progress_.due()) return;
    const double wall = seconds_since(begun_),
                 left = wall / static_cast<double>(done_) * static_cast<double>(waiting_.size() - done_);
    const std::int64_t failed = counts_.count(MemberState::failed);
    progress_.update(fmt::format("member {}/{}  {:.2g} s each  eta {:.0f} s{}", done_, waiting_.size(),
                                 wall / static_cast<double>(done_), left,
                                 failed > 0 ? fmt::format("  {} failed", failed) : ""));
  }

  void save() {
    if (!plan_.save || seconds_since(saved_) < plan_.save_interval || done_ == waiting_.size()) return;
    plan_.save();
    saved_ = WallClock::now();
  }

  EnsembleCounts& counts_;
  const MembersPlan& plan_;
  std::mutex mutex_;
  std::vector<std::int64_t> waiting_;
  std::size_t taken_ = 0, done_ = 0;
  MembersRun run_;
  std::exception_ptr failure_;
  Progress progress_;
  WallClock::time_point begun_ = WallClock::now(), saved_ = begun_;
};

}  // namespace

MembersRun run_members(const Members& members, EnsembleCounts& counts, const MembersPlan& plan) {
  Queue queue(counts, plan);
  const auto work = [&](const AnyDevice& device) {
    const Alone alone;
    try {
      while (const auto member = queue.next())
        queue.count(*member, outcome_of(members, *member, device, plan.edge_fails));
    } catch (...) {
      queue.note_failure(std::current_exception());
    }
  };
  std::vector<std::thread> threads;
  for (const AnyDevice& device : plan.devices) threads.emplace_back(work, std::cref(device));
  for (std::thread& thread : threads) thread.join();
  return queue.result();
}

}  // namespace talus::solver
