// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/stage/in_threads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <mutex>
#include <set>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "common/stage/machine.hpp"

namespace talus {
namespace {

/// The limit of threads while a test runs.
struct Limit {
  explicit Limit(int threads) { set_thread_limit(threads); }
  ~Limit() { set_thread_limit(0); }
};

TEST(InThreads, every_place_is_visited_once) {
  const Limit limit(8);
  std::vector<std::atomic<int>> visits(1000);
  in_threads(visits.size(), "visiting", [&](std::size_t place) { ++visits[place]; });
  for (const auto& count : visits) EXPECT_EQ(count, 1);
}

TEST(InThreads, no_more_threads_are_taken_than_the_process_may_have_nor_than_were_asked_for) {
  for (const auto& [threads, most] : {std::pair{3, 16}, std::pair{16, 3}, std::pair{1, 16}}) {
    const Limit limit(threads);
    std::set<std::thread::id> seen;
    std::mutex mutex;
    const auto note = [&](std::size_t) {
      const std::lock_guard lock(mutex);
      seen.insert(std::this_thread::get_id());
    };
    in_threads(500, "counting", note, static_cast<std::size_t>(most));
    EXPECT_LE(seen.size(), static_cast<std::size_t>(std::min(threads, most)));
    EXPECT_GE(seen.size(), 1U);
  }
}

TEST(InThreads, the_fault_of_the_lowest_place_is_thrown_and_nothing_is_begun_after_it) {
  const Limit limit(4);
  std::atomic<int> begun{0};
  const auto work = [&](std::size_t place) {
    ++begun;
    if (place >= 5) throw std::runtime_error(std::to_string(place));
  };
  try {
    in_threads(100'000, "failing", work);
    FAIL() << "nothing was thrown";
  } catch (const std::runtime_error& error) {
    EXPECT_EQ(error.what(), std::string("5"));  // places are taken in order: who takes 6 comes after who took 5
  }
  EXPECT_LE(begun, 9);  // each thread may have begun one more
}

TEST(InThreads, nothing_to_do_is_done_at_once) {
  in_threads(0, "idling", [](std::size_t) { FAIL(); });
}

}  // namespace
}  // namespace talus
