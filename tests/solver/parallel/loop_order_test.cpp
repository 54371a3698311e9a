// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What `make check-threads` can see of a loop on oneTBB. Without the thread sanitizer there is nothing to test here.
#include <gtest/gtest.h>

#include <cstdlib>
#include <thread>

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/loop_order.hpp"

#ifdef __SANITIZE_THREAD__
namespace talus {
namespace {

struct AddToOnePlace {
  int* sum;
  void operator()(int) const { *sum += 1; }
};
struct AddToEach {
  int* sums;
  void operator()(int i) const { sums[i] += 1; }
};

TEST(LoopOrder, the_sanitizer_sees_pieces_that_write_to_one_place) {
  if (std::thread::hardware_concurrency() < 2) GTEST_SKIP() << "this machine has one core";
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        int sum = 0;
        for (int loop = 0; loop < 4; ++loop) for_each(CpuDevice::make(), 1 << 22, AddToOnePlace{&sum});
        std::exit(0);  // which the sanitizer turns into 66
      },
      testing::ExitedWithCode(66), "data race");
}

TEST(LoopOrder, loops_over_the_same_places_one_after_the_other_are_no_race) {
  const CpuDevice device = CpuDevice::make();
  Buffer<int, CpuDevice> sums(device);
  sums.upload(std::vector<int>(1 << 20, 0));
  for (int loop = 0; loop < 4; ++loop) for_each(device, 1 << 20, AddToEach{sums.data()});
  EXPECT_EQ(sums.download()[1 << 19], 4);
}

}  // namespace
}  // namespace talus
#endif
