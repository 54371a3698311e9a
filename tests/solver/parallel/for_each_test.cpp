// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over an index: every index once, colour by colour, on one thread or all.
#include "solver/parallel/for_each.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <thread>

#include "common/domain/threads.hpp"
#include "common/stage/machine.hpp"
#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/alone.hpp"
#include "solver/parallel/pace.hpp"

namespace talus {
namespace {

struct CountVisits {
  int* visits;
  void operator()(int i) const { ++visits[i]; }
};

TEST(ForEach, visits_every_index_once) {
  for (const int count : {0, 1, 255, 256, 257, 5000}) {
    std::vector<int> visits(static_cast<std::size_t>(count) + 1);
    for_each(CpuDevice::make(), count, CountVisits{visits.data()});
    EXPECT_EQ(std::count(visits.begin(), visits.end() - 1, 1), count);
    EXPECT_EQ(visits.back(), 0) << "one behind the last of " << count;
  }
}

constexpr int block = 7, blocks = 40;  // points of a block; blocks of all four colours

/// One thread: one point. It counts the points before it in its block, and the earlier colours that are done.
struct Follow {
  int *place, *done, *earlier;
  void operator()(int p) const {
    place[p] = p % block == 0 ? 0 : place[p - 1] + 1;
    const int colour = p / block % 4;
    earlier[p] = 0;
    for (int c = 0; c < colour; ++c) earlier[p] += done[c] == block * blocks / 4 ? 1 : 0;
    atomic_increment(&done[colour]);
  }
};

TEST(ForEachGrouped, goes_colour_by_colour_and_through_each_block_in_order) {
  PointGroups groups;
  for (int b = 0; b < blocks; ++b) groups.ranges[b % 4].emplace_back(b * block, (b + 1) * block);
  std::vector<int> place(block * blocks, -1), earlier(block * blocks, -1);
  int done[4] = {};
  for_each_grouped(CpuDevice::make(), block * blocks, groups, Follow{place.data(), done, earlier.data()});
  for (int p = 0; p < block * blocks; ++p) {
    EXPECT_EQ(place[static_cast<std::size_t>(p)], p % block);
    EXPECT_EQ(earlier[static_cast<std::size_t>(p)], p / block % 4) << "colours done before point " << p;
  }
}

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

/// Seconds of `loops` loops that take so long alone and together, against what the better way takes.
double over_the_best(double alone, double together, int loops) {
  detail::LoopPace pace;
  double total = 0;
  for (int i = 0; i < loops; ++i) {
    const double seconds = pace.next_alone() ? alone : together;
    pace.note(seconds, 100);
    total += seconds;
  }
  return total / (loops * std::min(alone, together));
}

TEST(Pace, goes_the_way_that_takes_less_time) {
  EXPECT_LT(over_the_best(1e-3, 1e-4, 100000), 1.02) << "many cores";
  EXPECT_LT(over_the_best(5e-5, 1e-2, 100000), 1.2) << "waking takes 10 ms on a busy machine";
  EXPECT_LT(over_the_best(1e-3, 1e-3, 100000), 1.02);
}

TEST(Pace, comes_back_when_the_machine_is_free_again) {
  detail::LoopPace pace;
  int alone = 0;
  const auto loop = [&](double together) {
    const bool stays = pace.next_alone();
    alone += stays;
    pace.note(stays ? 1e-4 : together, 1);
  };
  for (int i = 0; i < 1000; ++i) loop(1e-2);
  EXPECT_GT(alone, 900);
  alone = 0;
  for (int i = 0; i < 50000; ++i) loop(2e-5);
  EXPECT_LT(alone, 10000);
}

TEST(Pace, sums_have_the_same_bits_on_one_thread_as_on_many) {
  const CpuDevice device = CpuDevice::make();
  const int count = 100003;  // no multiple of what is summed at a time
  std::vector<double> a, b;
  for (int i = 0; i < count; ++i) {
    a.push_back(std::sin(i) * std::pow(10, i % 17));
    b.push_back(std::cos(3 * i));
  }
  limit_threads_of_libraries(1);
  const double alone = inner_product(device, a.data(), b.data(), count);
  limit_threads_of_libraries(usable_threads() + 1);
  for (int i = 0; i < 200; ++i) ASSERT_EQ(inner_product(device, a.data(), b.data(), count), alone) << "loop " << i;
  limit_threads_of_libraries(usable_threads());
}

}  // namespace
}  // namespace talus
