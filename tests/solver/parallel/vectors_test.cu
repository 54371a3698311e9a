// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs of Krylov methods on vectors over the nodes, on both devices, against plain loops.
#include "solver/parallel/vectors.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

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

}  // namespace
}  // namespace talus::solver::testing
