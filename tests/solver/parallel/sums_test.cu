// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums, runs of equal keys, vectors over the nodes and layers of columns, on both devices, against plain loops.
#include "solver/parallel/sums.hpp"

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/columns.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct Waves {
  int* seen;
  TALUS_HD Terms<3> operator()(int i) const {
    seen[i] += 1;
    return {{1.0, 1e-3 * i, sin(0.1 * i)}};
  }
};
struct Finish {
  double* total;
  TALUS_HD void operator()(const double* sums) const {
    for (int k = 0; k < 3; ++k) total[k] = sums[k];
    total[3] += 1;
  }
};

/// Counts its calls, and the indices done until then.
struct CountSeen {
  const int* seen;
  int count;
  int* found;
  unsigned* at;
  TALUS_HD unsigned* ticket() const { return at; }
  TALUS_HD void operator()() const {
    ++found[0];
    for (int i = 0; i < count; ++i) found[1] += seen[i];
  }
};
struct SeeOne {
  int* seen;
  TALUS_HD void operator()(int i) const { seen[i] = 1; }
};

class Sums : public InEachPlace {
 protected:
  template <class Device>
  static void finish_once() {
    const Device device = Device::make();
    Buffer<unsigned, Device> ticket(device);
    ticket.upload({0U});
    for (const int count : {0, 1, 33, 5000, 70000}) {
      Buffer<int, Device> seen(device), found(device);
      seen.resize_zeroed(static_cast<std::size_t>(std::max(count, 1)));
      found.resize_zeroed(2);
      for (int repeat = 0; repeat < 2; ++repeat)
        for_each_then(device, count, SeeOne{seen.data()}, CountSeen{seen.data(), count, found.data(), ticket.data()});
      EXPECT_EQ(found.download(), (std::vector<int>{2, 2 * count}));
    }
  }
  template <class Device>
  static void add_up() {
    const Device device = Device::make();
    SumSpace<Device> space(device);
    for (const int count : {0, 1, 31, 33, 5000, 70000, 300000}) {
      Buffer<int, Device> seen(device);
      seen.upload(std::vector<int>(static_cast<std::size_t>(std::max(count, 1)), 0));
      std::vector<double> first;
      for (int repeat = 0; repeat < 3; ++repeat) {
        Buffer<double, Device> total(device);
        total.upload({-1, -1, -1, 0});
        sum_each<3>(device, count, space, Waves{seen.data()}, Finish{total.data()});
        const auto got = total.download();
        double expected[3] = {};
        for (int i = 0; i < count; ++i) {
          expected[0] += 1;
          expected[1] += 1e-3 * i;
          expected[2] += std::sin(0.1 * i);
        }
        EXPECT_EQ(got[0], expected[0]);
        EXPECT_NEAR(got[1], expected[1], 1e-12 * expected[1]);
        EXPECT_NEAR(got[2], expected[2], 1e-9);
        EXPECT_EQ(got[3], 1) << "finished once";
        if (repeat == 0) first = got;
        EXPECT_EQ(got, first) << "the same bits on every run";
      }
      for (const int times : seen.download()) EXPECT_EQ(times, count > 0 ? 3 : 0);
    }
  }
};

TEST_P(Sums, of_a_loop_are_made_once_it_is_done) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return finish_once<GpuDevice>();
#endif
  finish_once<CpuDevice>();
}
TEST_P(Sums, are_finished_once_and_repeat_to_the_bit) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return add_up<GpuDevice>();
#endif
  add_up<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Sums);

class Runs : public InEachPlace {
 protected:
  template <class Device>
  static void find() {
    const Device device = Device::make();
    Buffer<int, Device> starts(device), scratch(device);
    std::vector<std::uint64_t> many;  // runs of one to five, and keys that differ in their high bits alone
    for (std::uint64_t r = 0; r < 2000; ++r) many.insert(many.end(), 1 + r * r % 5, r << 33);
    for (const auto& keys : {std::vector<std::uint64_t>{}, {7}, {7, 7, 7}, {1, 2, 2, 9}, many}) {
      Buffer<std::uint64_t, Device> on_device(device);
      on_device.upload(keys);
      std::vector<int> expected;
      for (std::size_t i = 0; i < keys.size(); ++i) {
        if (i == 0 || keys[i] != keys[i - 1]) expected.push_back(static_cast<int>(i));
      }
      EXPECT_EQ(find_runs(on_device, starts, scratch), static_cast<int>(expected.size()));
      expected.push_back(static_cast<int>(keys.size()));
      EXPECT_EQ(starts.download(), expected) << "of " << keys.size() << " keys";
    }
  }
};

TEST_P(Runs, begin_where_a_key_differs_from_the_one_before) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return find<GpuDevice>();
#endif
  find<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Runs);

class Vectors : public InEachPlace {
 protected:
  template <class Device>
  static void compute() {
    const Device device = Device::make();
    std::vector<Vec3<double>> a, b;
    for (int n = 0; n < 3000; ++n) {  // small whole numbers: products and sums are exact in any order
      a.push_back({1.0 * (n % 7), 1.0 * (n % 5), -1.0 * (n % 3)});
      b.push_back({1.0 * (n % 4), -2.0, 1.0 * (n % 6)});
    }
    NodeVector<Device> x(device), y(device), z(device);
    x.upload(a);
    y.upload(b);
    copy(y, z);
    axpby(3, x, -2, z);
    const auto sum = z.download();
    ASSERT_EQ(sum.size(), a.size());
    for (std::size_t n = 0; n < a.size(); ++n) {
      EXPECT_EQ(sum[n].x, 3 * a[n].x - 2 * b[n].x);
      EXPECT_EQ(sum[n].y, 3 * a[n].y - 2 * b[n].y);
      EXPECT_EQ(sum[n].z, 3 * a[n].z - 2 * b[n].z);
    }
  }
};

TEST_P(Vectors, are_copied_and_summed_number_by_number) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return compute<GpuDevice>();
#endif
  compute<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Vectors);

constexpr int of_block = 16, blocks = 5;

/// One column: the sum of its layers' numbers, and how often a layer was met.
struct SumLayers {
  double* total;
  int* met;
  struct Column {
    bool inside;
    int first, last, number;
  };
  struct Sums {
    double layers = 0;
    TALUS_HD Sums& operator+=(const Sums& o) {
      layers += o.layers;
      return *this;
    }
  };
  TALUS_HD Column locate(int c) const { return {c % 5 != 0, c % 3, c % 3 + c % 23, c}; }
  TALUS_HD void layer(const Column& at, int k, Sums& sums) const {
    met[at.number * 32 + k] += 1;
    sums.layers += k + 1;
  }
  TALUS_HD void finish(const Column& at, const Sums& sums) const { total[at.number] += sums.layers; }
};

/// One column: every layer takes the sum of the numbers in all of them.
struct ShareSum {
  double* number;
  using Column = SumLayers::Column;
  using Sums = SumLayers::Sums;
  struct Pass {
    double sum = 0;
  };
  TALUS_HD Column locate(int c) const { return {c % 5 != 0, c % 3, c % 3 + c % 23, c}; }
  TALUS_HD void layer(const Column& at, int k, Sums& sums) const { sums.layers += number[at.number * 32 + k]; }
  TALUS_HD Pass between(const Column&, const Sums& sums) const { return {sums.layers}; }
  TALUS_HD void again(const Column& at, const Pass& pass, int k) const { number[at.number * 32 + k] = pass.sum; }
};

class Columns : public InEachPlace {
 protected:
  template <class Device>
  static void add_up() {
    const Device device = Device::make();
    Buffer<double, Device> total(device);
    Buffer<int, Device> met(device);
    total.upload(std::vector<double>(of_block * blocks, 0.5));
    met.upload(std::vector<int>(of_block * blocks * 32, 0));
    for_each_column<of_block>(device, blocks, SumLayers{total.data(), met.data()});
    const auto sums = total.download();
    const auto times = met.download();
    for (int c = 0; c < of_block * blocks; ++c) {
      const int first = c % 3, last = c % 3 + c % 23;
      double expected = 0.5;  // once, and whole numbers beyond: exact in any order
      for (int k = 0; k < 32; ++k) {
        const bool in = c % 5 != 0 && k >= first && k < last;
        if (in) expected += k + 1;
        EXPECT_EQ(times[static_cast<std::size_t>(c * 32 + k)], in ? 1 : 0) << "column " << c << ", layer " << k;
      }
      EXPECT_EQ(sums[static_cast<std::size_t>(c)], expected) << "column " << c;
    }
  }

  template <class Device>
  static void share() {
    const Device device = Device::make();
    Buffer<double, Device> number(device);
    std::vector<double> numbers(of_block * blocks * 32);
    for (std::size_t n = 0; n < numbers.size(); ++n) numbers[n] = static_cast<double>(n % 7);
    number.upload(numbers);
    for_each_column_twice<of_block>(device, blocks, ShareSum{number.data()});
    const auto after = number.download();
    for (int c = 0; c < of_block * blocks; ++c) {
      const int first = c % 3, last = c % 3 + c % 23;
      double sum = 0;  // of whole numbers: exact in any order
      for (int k = first; k < last; ++k) sum += numbers[static_cast<std::size_t>(c * 32 + k)];
      for (int k = 0; k < 32; ++k) {
        const auto n = static_cast<std::size_t>(c * 32 + k);
        const bool in = c % 5 != 0 && k >= first && k < last;
        EXPECT_EQ(after[n], in ? sum : numbers[n]) << "column " << c << ", layer " << k;
      }
    }
  }
};

TEST_P(Columns, know_their_sum_when_they_meet_their_layers_again) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return share<GpuDevice>();
#endif
  share<CpuDevice>();
}

TEST_P(Columns, meet_each_of_their_layers_once_and_finish_with_the_sum) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return add_up<GpuDevice>();
#endif
  add_up<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Columns);

}  // namespace
}  // namespace talus::solver::testing
