// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work that repeats, recorded on a GPU and done as it is given on the CPU.
#include "solver/parallel/recording.hpp"

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/launch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct AddTo {
  int* numbers;
  int amount;
  TALUS_HD void operator()(int i) const { numbers[i] += amount; }
};

class Recordings : public InEachPlace {
 protected:
  template <class Device>
  static void repeat() {
    const Device device = Device::make();
    Buffer<int, Device> numbers(device);
    numbers.upload(std::vector<int>(100, 0));
    Recording<Device> recording(device);
    int amount = 1;
    const auto body = [&] { for_each(device, 100, AddTo{numbers.data(), amount}); };
    recording.repeat(0, body);
    EXPECT_EQ(numbers.download()[99], 0);
    recording.repeat(1, body);
    EXPECT_EQ(numbers.download()[99], 1);
    recording.repeat(5, body);
    EXPECT_EQ(numbers.download()[99], 6);
    recording.forget();
    amount = 10;
    recording.repeat(3, body);
    EXPECT_EQ(numbers.download()[99], 36) << "a kernel with new arguments was not recorded anew";
  }
};

TEST_P(Recordings, do_their_body_as_often_as_asked) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return repeat<GpuDevice>();
#endif
  repeat<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Recordings);

}  // namespace
}  // namespace talus::solver::testing
