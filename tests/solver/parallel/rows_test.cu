// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums over the terms of every row, on both devices, against a plain loop.
#include "solver/parallel/rows.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr int parts = 45, rows = 1000;

struct Terms45 {
  Vec3<double>* sums;
  TALUS_HD Vec3<double> term(int i, int part) const { return {1.0, 1.0 * part, 1.0 * i * part}; }
  TALUS_HD void finish(int i, const Vec3<double>& sum) const { sums[i] += sum; }
};
/// The same, with nothing to do where a flag says so.
struct IdleTerms45 : Terms45 {
  const int* flag;
  TALUS_HD bool idle() const { return *flag != 0; }
};

class Rows : public InEachPlace {
 protected:
  template <class Device>
  static void add_up() {
    const Device device = Device::make();
    Buffer<Vec3<double>, Device> sums(device);
    sums.upload(std::vector<Vec3<double>>(rows, {0.5, 0, 0}));
    Buffer<int, Device> flag(device);
    flag.upload({1});
    sum_rows<parts>(device, rows, IdleTerms45{{sums.data()}, flag.data()});
    EXPECT_EQ(sums.download()[7].x, 0.5) << "an idle kernel has done something";
    sum_rows<parts>(device, rows, Terms45{sums.data()});
    const auto got = sums.download();
    for (int i = 0; i < rows; ++i) {  // whole numbers and a half: exact in any order
      EXPECT_EQ(got[static_cast<std::size_t>(i)].x, parts + 0.5);
      EXPECT_EQ(got[static_cast<std::size_t>(i)].y, parts * (parts - 1) / 2);
      EXPECT_EQ(got[static_cast<std::size_t>(i)].z, i * (parts * (parts - 1) / 2));
    }
    flag.upload({0});
    sum_rows<parts>(device, rows, IdleTerms45{{sums.data()}, flag.data()});
    EXPECT_EQ(sums.download()[7].x, 2 * parts + 0.5);
  }
};

TEST_P(Rows, are_finished_once_with_the_sum_of_all_their_terms) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return add_up<GpuDevice>();
#endif
  add_up<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Rows);

}  // namespace
}  // namespace talus::solver::testing
