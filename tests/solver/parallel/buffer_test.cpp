// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays on devices, their sorts and sums, and atomic updates from many threads.
#include "solver/parallel/buffer.hpp"

#include <numeric>
#include <random>

#include "solver/parallel/atomics.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

class BufferOn : public InEachPlace {
 protected:
  /// Calls check(device) on a new device.
  template <class Check>
  static void on_device(const Check& check) {
    if (GetParam() == On::gpu) return check(GpuDevice::make());
    check(CpuDevice::make());
  }
};

TEST_P(BufferOn, gives_back_what_went_in) {
  on_device([](const auto& device) {
    using Device = std::decay_t<decltype(device)>;
    for (const std::size_t size : {1u, 100u, 1000u, 100000u}) {
      std::vector<int> values(size);
      std::iota(values.begin(), values.end(), 7);
      Buffer<int, Device> buffer(device);
      buffer.upload(values);
      EXPECT_EQ(buffer.download(), values);
      buffer.fill_zero();
      EXPECT_EQ(buffer.download(), std::vector<int>(size, 0));
    }
  });
}

TEST_P(BufferOn, keeps_apart_many_small_uploads_in_flight) {
  on_device([](const auto& device) {
    using Device = std::decay_t<decltype(device)>;
    std::vector<Buffer<int, Device>> buffers;
    for (int n = 0; n < 3000; ++n) {
      buffers.emplace_back(device);
      buffers.back().upload(std::vector<int>(static_cast<std::size_t>(1 + n % 40), n));
    }
    for (int n = 0; n < 3000; ++n)
      ASSERT_EQ(buffers[static_cast<std::size_t>(n)].download(),
                std::vector<int>(static_cast<std::size_t>(1 + n % 40), n));
  });
}

TEST_P(BufferOn, takes_an_eighth_more_than_asked_for_once_it_grows) {
  on_device([](const auto& device) {
    Buffer<double, std::decay_t<decltype(device)>> buffer(device, 80);
    EXPECT_EQ(buffer.bytes(), 80 * sizeof(double));
    buffer.resize(40);
    EXPECT_EQ(buffer.size(), 40u);
    EXPECT_EQ(buffer.bytes(), 80 * sizeof(double));
    buffer.resize(160);
    EXPECT_EQ(buffer.bytes(), 180 * sizeof(double));
    buffer.drop();
    EXPECT_EQ(buffer.size(), 0u);
    EXPECT_EQ(buffer.bytes(), 0u);
  });
}

TALUS_IN_EACH_PLACE(BufferOn);

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
}  // namespace talus::solver::testing
