// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs of equal keys, on both devices, against a plain loop.
#include "solver/parallel/runs.hpp"

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

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

}  // namespace
}  // namespace talus::solver::testing
