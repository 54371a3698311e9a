// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Loops over the layers of columns, on both devices, against a plain loop.
#include "solver/parallel/columns.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

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
