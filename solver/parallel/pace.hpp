// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a loop on the CPU goes to all threads or stays on the calling one: where others have work of their own, and
// by what either took. And what happens before what in one that goes to all, for the thread sanitizer: it cannot see
// how oneTBB, which is not compiled with it, hands work over. With this it sees two pieces of one loop that write to
// the same place.
#pragma once

#include <chrono>
#include <unordered_map>

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
// Reads what oneTBB has copied from another thread.
#define TALUS_HANDED_OVER __attribute__((no_sanitize("thread")))
#else
#define TALUS_HANDED_OVER
#endif

namespace talus {

/// While it lives, loops and sums that this thread starts on a CpuDevice stay on this thread. Their results have the
/// same bits as on all threads.
class Alone {
 public:
  Alone();
  ~Alone();
  Alone(const Alone&) = delete;
  Alone& operator=(const Alone&) = delete;

  static bool here();  ///< whether the calling thread works alone

 private:
  bool before_;
};

}  // namespace talus

namespace talus::detail {

/// True where the thread sanitizer watches. It would take each hand-over inside oneTBB's own sort for a race.
#ifdef __SANITIZE_THREAD__
inline constexpr bool under_thread_sanitizer = true;
#else
inline constexpr bool under_thread_sanitizer = false;
#endif

/// Lives as long as a loop, on the thread that calls it. Costs nothing without the sanitizer.
class LoopOrder {
 public:
#ifdef __SANITIZE_THREAD__
  LoopOrder() { __tsan_release(&begun_); }
  ~LoopOrder() { __tsan_acquire(&ended_); }
  void begin_piece() const { __tsan_acquire(&begun_); }
  void end_piece() const { __tsan_release(&ended_); }

 private:
  mutable char begun_ = 0, ended_ = 0;
#else
  void begin_piece() const {}
  void end_piece() const {}
#endif
};

/// What one loop took, on the calling thread alone and on all together. Times are sums in which older loops fade.
class LoopPace {
 public:
  bool next_alone();  ///< which way the next loop of this kind goes
  /// The time that it took [s], and how much there was to do (any unit, the same for every loop of the kind).
  void note(double seconds, double items);
  bool usually_alone() const { return usually_alone_; }  ///< which way is the usual one

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
