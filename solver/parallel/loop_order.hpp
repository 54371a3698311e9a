// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What happens before what in a parallel loop, for the thread sanitizer: it cannot see how oneTBB, which is not
// compiled with it, hands work over. With this it sees two pieces of one loop that write to the same place.
#pragma once

#ifdef __SANITIZE_THREAD__
#include <sanitizer/tsan_interface.h>
// Reads what oneTBB has copied from another thread.
#define TALUS_HANDED_OVER __attribute__((no_sanitize("thread")))
#else
#define TALUS_HANDED_OVER
#endif

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

}  // namespace talus::detail
