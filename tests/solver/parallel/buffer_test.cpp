// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays on devices: sizes, copies both ways, swaps.
#include "solver/parallel/buffer.hpp"

#include <numeric>

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

}  // namespace
}  // namespace talus::solver::testing
