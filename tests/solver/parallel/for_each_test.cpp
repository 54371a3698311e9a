// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over an index: every index once, and grouped points colour by colour in the order of their blocks.
#include "solver/parallel/for_each.hpp"

#include <gtest/gtest.h>

#include <algorithm>

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

}  // namespace
}  // namespace talus
