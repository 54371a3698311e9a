// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a loop goes to all threads or stays on one: by what either takes, and never seen in a result.
#include "solver/parallel/pace.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "common/domain/threads.hpp"
#include "common/stage/machine.hpp"
#include "solver/parallel/algorithms.hpp"

namespace talus {
namespace {

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
