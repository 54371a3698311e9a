// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums that are finished where they are made.
#include "solver/parallel/sums.hpp"
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

class Sums : public InEachPlace {
 protected:
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

TEST_P(Sums, are_finished_once_and_repeat_to_the_bit) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return add_up<GpuDevice>();
#endif
  add_up<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Sums);

}  // namespace
}  // namespace talus::solver::testing
