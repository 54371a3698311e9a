// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Work that repeats, recorded on a GPU and done as it is given on the CPU; memory of the host.
#include "solver/parallel/recording.hpp"

#include "solver/parallel/for_each.hpp"
#include "solver/parallel/host_room.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct AddTo {
  int* numbers;
  int amount;
  TALUS_HD void operator()(int i) const { numbers[i] += amount; }
};

struct MultiplyBy {
  int* numbers;
  int factor;
  TALUS_HD void operator()(int i) const { numbers[i] *= factor; }
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
    recording.forget();
    recording.repeat(4, [&] {
      body();
      for_each(device, 50, AddTo{numbers.data(), 1000});
    });
    EXPECT_EQ(numbers.download()[99], 76) << "a recording of more kernels was not recorded anew";
    EXPECT_EQ(numbers.download()[49], 4076);
    recording.forget();
    recording.repeat(2, [&] { for_each(device, 100, MultiplyBy{numbers.data(), 2}); });
    EXPECT_EQ(numbers.download()[49], 4 * 4076) << "another kernel was not recorded anew";
    EXPECT_EQ(numbers.download()[99], 4 * 76);
  }
};

TEST_P(Recordings, do_their_body_as_often_as_asked) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return repeat<GpuDevice>();
#endif
  repeat<CpuDevice>();
}
TALUS_IN_EACH_PLACE(Recordings);

struct Numbers {
  double first;
  int rest[3];
  std::uint32_t last;
};

struct CopyNumbers {
  const Numbers* from;
  Numbers* to;
  TALUS_HD void operator()(int) const { *to = *from; }
};

class HostRooms : public OnEachDevice {};

TEST_P(HostRooms, are_read_and_written_by_kernels) {
  on_device([](const auto& device) {
    using Device = std::decay_t<decltype(device)>;
    HostRoom<Numbers, Device> in(device), out(device);
    EXPECT_EQ((*in).first, 0) << "it is empty to begin with";
    *in = {2.5, {1, 2, 3}, 7};
    for_each(device, 1, CopyNumbers{&*in, &*out});
    synchronise(device);
    EXPECT_EQ((*out).first, 2.5);
    EXPECT_EQ((*out).rest[2], 3);
    EXPECT_EQ((*out).last, 7u);
  });
}

TEST_P(HostRooms, are_lent_again_once_they_were_given_back) {
  on_device([](const auto& device) {
    using Device = std::decay_t<decltype(device)>;
    for (int turn = 0; turn < 3; ++turn) {
      HostRoom<Numbers, Device> room(device);
      EXPECT_EQ((*room).last, 0u) << "nothing of an earlier owner is left";
      *room = {1, {}, 9};
    }
  });
}
TALUS_IN_EACH_PLACE(HostRooms);

}  // namespace
}  // namespace talus::solver::testing
