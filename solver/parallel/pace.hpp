// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a loop on the CPU goes to all threads or stays on the calling one, by what either took.
#pragma once

#include <chrono>
#include <unordered_map>

namespace talus::detail {

/// What one loop took, on the calling thread alone and on all together. Times are sums in which older loops fade.
class LoopPace {
 public:
  /// Which way the next loop of this kind goes.
  bool next_alone();
  /// The time that it took [s], and how much there was to do (any unit, the same for every loop of the kind).
  void note(double seconds, double items);
  /// Which way is the usual one.
  bool usually_alone() const { return usually_alone_; }

 private:
  struct Times {
    double seconds = 0, items = 0;
    double each() const { return items > 0 ? seconds / items : 0; }
  };

  Times together_, alone_;
  bool usually_alone_ = false;  // the first loops go to all threads
  long until_trial_ = 4;        // loops, before the other way is tried again
  long interval_ = 64;          // between trials
  int trial_ = 0;               // loops of a trial that are left
};

/// True where this process may run on one thread only, or this thread works alone: then nothing goes to others.
bool is_single_threaded();

/// Runs alone() or together(), two ways to the same bits, and returns what it returns. `kind` tells loops apart, such
/// as the address of their body. Waking threads takes microseconds, and milliseconds where other processes have the
/// cores; small loops then take less time alone. Which way a loop goes is measured, tried again now and then, and never
/// changes a result.
template <class Alone, class Together>
auto paced(const void* kind, double items, const Alone& alone, const Together& together) {
  using Clock = std::chrono::steady_clock;
  if (is_single_threaded()) return alone();
  thread_local std::unordered_map<const void*, LoopPace> paces;
  LoopPace& pace = paces[kind];
  struct Timed {
    LoopPace& pace;
    double items;
    Clock::time_point begun = Clock::now();
    ~Timed() { pace.note(std::chrono::duration<double>(Clock::now() - begun).count(), items); }
  };
  const bool stays = pace.next_alone();
  const Timed timed{pace, items};
  return stays ? alone() : together();
}

}  // namespace talus::detail
