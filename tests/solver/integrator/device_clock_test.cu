// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The clock that host and kernels change in turns.
#include "solver/integrator/device_clock.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

struct OneStep {
  Clock* clock;
  TALUS_HD void operator()(int) const { clock->begin_step(); }
};

class TheDeviceClock : public InEachPlace {
 protected:
  template <class Device>
  static void take_turns() {
    const Device device = Device::make();
    Clock start;
    start.control.longest = 0.5;
    start.next_event = 10;
    DeviceClock<Device> clock(device, start);
    const Clock* const where = clock.data();
    EXPECT_EQ(clock.read().step, 0);
    const auto steps = [&](int count) {
      clock.hand_over();
      for (int k = 0; k < count; ++k) for_each(device, 1, OneStep{clock.data()});
    };
    steps(3);
    EXPECT_EQ(clock.read().step, 3) << "what kernels did";
    EXPECT_EQ(clock.read().time, 1.5) << "read again";
    Clock changed = clock.read();
    changed.next_event = 2;
    clock.write(changed);
    EXPECT_EQ(clock.read().next_event, 2) << "what the host did";
    steps(4);
    EXPECT_EQ(clock.read().time, 2);
    EXPECT_EQ(clock.read().alarms.halt, at_event);
    steps(1);
    EXPECT_EQ(clock.read().step, 4) << "handed over without a change of the host";
    EXPECT_EQ(clock.data(), where);
  }
};

TEST_P(TheDeviceClock, is_the_one_that_was_changed_last) {
#if TALUS_FOR_GPU
  if (GetParam() == On::gpu) return take_turns<GpuDevice>();
#endif
  take_turns<CpuDevice>();
}
TALUS_IN_EACH_PLACE(TheDeviceClock);

}  // namespace
}  // namespace talus::solver::testing
