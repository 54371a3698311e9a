// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops that stay on the thread that starts them, and only there.
#include "solver/parallel/alone.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <thread>
#include <vector>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/pace.hpp"

namespace talus {
namespace {

/// Counts the indices that another thread than `caller` ran.
struct CountStrangers {
  std::thread::id caller;
  std::atomic<int>* strangers;
  std::vector<int>* seen;
  void operator()(int i) const {
    if (std::this_thread::get_id() != caller) ++*strangers;
    (*seen)[static_cast<std::size_t>(i)] += 1;
  }
};

TEST(Alone, keeps_loops_on_the_calling_thread) {
  constexpr int count = 100'000;
  std::vector<int> seen(count, 0);
  std::atomic<int> strangers{0};
  const Alone alone;
  for (int loop = 0; loop < 8; ++loop)
    for_each(CpuDevice::make(), count, CountStrangers{std::this_thread::get_id(), &strangers, &seen});
  EXPECT_EQ(strangers, 0);
  EXPECT_EQ(seen, std::vector<int>(count, 8)) << "every index runs once a loop";
}

TEST(Alone, ends_where_it_began_and_is_of_one_thread) {
  EXPECT_FALSE(Alone::here());
  {
    const Alone outer;
    {
      const Alone inner;
      EXPECT_TRUE(Alone::here());
    }
    EXPECT_TRUE(Alone::here());
    EXPECT_TRUE(detail::is_single_threaded());
    bool other = true;
    std::thread([&] { other = Alone::here(); }).join();
    EXPECT_FALSE(other);
  }
  EXPECT_FALSE(Alone::here());
}

}  // namespace
}  // namespace talus
