// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sorts and sums of integers against those of the standard library.
#include "solver/parallel/algorithms.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

namespace talus::solver::testing {
namespace {

TEST(Sorting, is_stable_and_sums_are_exclusive_on_the_cpu) {
  std::mt19937 engine(5);
  std::vector<std::uint64_t> keys(10000);
  for (auto& key : keys) key = engine() % 97;
  std::vector<int> expected(keys.size());
  std::iota(expected.begin(), expected.end(), 0);
  std::stable_sort(expected.begin(), expected.end(),
                   [&](int a, int b) { return keys[static_cast<std::size_t>(a)] < keys[static_cast<std::size_t>(b)]; });
  const CpuDevice device = CpuDevice::make();
  Buffer<std::uint64_t, CpuDevice> sorted(device);
  Buffer<int, CpuDevice> order(device);
  sorted.upload(keys);
  sort_order(device, sorted, order);
  EXPECT_EQ(order.download(), expected);
  const std::vector<int> values{3, 0, 5, 1};
  std::vector<int> sums(4);
  EXPECT_EQ(exclusive_sum(device, values.data(), sums.data(), 4), 9);
  EXPECT_EQ(sums, (std::vector<int>{0, 3, 3, 8}));
}

}  // namespace
}  // namespace talus::solver::testing
