// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Atomic updates of one location from many threads, against what a plain loop leaves there.
#include "solver/parallel/atomics.hpp"

#include <gtest/gtest.h>

#include "solver/parallel/for_each.hpp"

namespace talus {
namespace {

constexpr int count = 10000;

/// Every whole number below `count` once, in no order.
int value(int i) { return i * 7919 % count; }

struct Totals {
  double sum = 0;
  int least = count, most = -1, times = 0, flag = 0, first = -1;
  std::uint32_t largest_bits = 0;
};

/// One thread: one value.
struct Collect {
  Totals* totals;
  void operator()(int i) const {
    atomic_add(&totals->sum, value(i));
    atomic_min(&totals->least, value(i));
    atomic_max(&totals->most, value(i));
    atomic_increment(&totals->times);
    atomic_max_positive(&totals->largest_bits, 1e-3f * static_cast<float>(value(i)));
    replace_if(&totals->first, -1, value(i));
    if (value(i) == 77) raise_flag(&totals->flag, 3);
  }
};

TEST(Atomics, lose_no_update_of_any_thread) {
  Totals totals;
  for_each(CpuDevice::make(), count, Collect{&totals});
  EXPECT_EQ(totals.sum, 0.5 * count * (count - 1)) << "whole numbers, so that every order has the same sum";
  EXPECT_EQ(totals.least, 0);
  EXPECT_EQ(totals.most, count - 1);
  EXPECT_EQ(totals.times, count);
  EXPECT_EQ(positive_from_bits(totals.largest_bits), 1e-3f * (count - 1));
  EXPECT_EQ(totals.flag, 3);
}

TEST(Atomics, replace_only_what_is_expected) {
  int at = -1;
  replace_if(&at, -1, 5);
  EXPECT_EQ(at, 5);
  replace_if(&at, -1, 7);
  EXPECT_EQ(at, 5);
}

TEST(Atomics, leave_what_is_already_as_large_or_as_small) {
  int at = 4;
  atomic_min(&at, 6);
  EXPECT_EQ(at, 4);
  atomic_max(&at, 2);
  EXPECT_EQ(at, 4);
}

TEST(Atomics, scatter_mass_and_momentum_into_their_places) {
  Vec4<double> node{1, 2, 3, 4};
  const double w = node.w, x = node.x, y = node.y, z = node.z;
  scatter_add(&node, 10.0, Vec3<double>{20, 30, 40});
  EXPECT_EQ(node.w, w + 10);
  EXPECT_EQ(node.x, x + 20);
  EXPECT_EQ(node.y, y + 30);
  EXPECT_EQ(node.z, z + 40);
}

}  // namespace
}  // namespace talus
