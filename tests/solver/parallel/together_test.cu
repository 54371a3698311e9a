// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs that share a GPU: whatever is started with the work of others does what it would do alone.
#include "solver/parallel/together.hpp"

#include <cstring>
#include <numeric>
#include <thread>

#include "solver/parallel/any_device.hpp"
#include "solver/parallel/host_room.hpp"
#include "solver/parallel/launch.hpp"
#include "solver/parallel/launch_list.hpp"
#include "solver/parallel/recording.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// The steps of a run, as a clock on the device would have them: with others more are started than are taken.
struct Steps {
  int taken, most, acts;
};
struct BeginStep {
  static constexpr bool with_other_runs = true;
  Steps* steps;
  TALUS_HD void operator()(int) const {
    steps->acts = steps->taken < steps->most ? 1 : 0;
    steps->taken += steps->acts;
  }
};
struct AddIndex {
  static constexpr bool with_other_runs = true;
  const Steps* steps;
  int* numbers;
  int amount;
  TALUS_HD void operator()(int i) const {
    if (steps->acts != 0) numbers[i] += amount * i;
  }
};
struct Double {
  static constexpr bool with_other_runs = true;
  const Steps* steps;
  int* numbers;
  TALUS_HD void operator()(int i) const {
    if (steps->acts != 0) numbers[i] = 2 * numbers[i] % 1009;
  }
};
/// Starts alone.
struct Increase {
  const Steps* steps;
  int* numbers;
  TALUS_HD void operator()(int i) const {
    if (steps->acts != 0) ++numbers[i];
  }
};

/// What a run starts in each of its steps.
enum class Work { add, add_and_double, zero_and_add, increase };

/// The numbers of a run after `steps` steps with kernels of `amount`, worked out by plain loops.
std::vector<int> expected(std::vector<int> numbers, Work work, int amount, int steps) {
  for (int step = 0; step < steps; ++step) {
    for (std::size_t i = 0; i < numbers.size(); ++i) {
      numbers[i] += work == Work::increase ? 1 : amount * static_cast<int>(i);
      if (work == Work::add_and_double) numbers[i] = 2 * numbers[i] % 1009;
    }
  }
  return numbers;
}

/// A run on a device of its own.
template <class Device>
class SmallRun {
 public:
  SmallRun(const Device& device, int number, Work work, bool with_others)
      : device_(device),
        work_(work),
        numbers_(1 + 700 * static_cast<std::size_t>(number)),
        on_device_(device),
        spare_(device),
        steps_(device, 1),
        room_(device),
        recording_(device, with_others) {
    std::iota(numbers_.begin(), numbers_.end(), number);
    on_device_.upload(numbers_);
    spare_.upload(numbers_);
  }

  /// Steps in one batch, given in and looked at as a solver does with its clock.
  void batch(int steps) {
    *room_ = {0, steps, 0};
    recording_.repeat(
        steps, [&] { step(); }, [&] { room_.copy_to(steps_.data()); }, [&] { room_.copy_from(steps_.data()); });
    synchronise(device_);
    EXPECT_EQ((*room_).taken, steps);
    numbers_ = expected(std::move(numbers_), work_, amount_, steps);
    ASSERT_EQ(on_device_.download(), numbers_);
    if (work_ == Work::zero_and_add && steps > 0) {
      EXPECT_EQ(spare_.download(), std::vector<int>(spare_.size(), 0));
    }
  }
  /// From here on kernels have other arguments.
  void change(int amount) {
    amount_ = amount;
    recording_.forget();
    spare_.upload(numbers_);
  }

 private:
  void step() {
    const int count = static_cast<int>(on_device_.size());
    if (work_ == Work::zero_and_add) spare_.fill_zero();
    for_each(device_, 1, BeginStep{steps_.data()});
    if (work_ == Work::increase) return for_each(device_, count, Increase{steps_.data(), on_device_.data()});
    for_each(device_, count, AddIndex{steps_.data(), on_device_.data(), amount_});
    if (work_ == Work::add_and_double) for_each(device_, count, Double{steps_.data(), on_device_.data()});
  }

  Device device_;
  Work work_;
  int amount_ = 1;
  std::vector<int> numbers_;
  Buffer<int, Device> on_device_, spare_;
  Buffer<Steps, Device> steps_;
  HostRoom<Steps, Device> room_;
  Recording<Device> recording_;
};

/// Batches of several lengths, with new arguments every few of them.
template <class Device>
void run(const Device& device, int number, Work work) {
  SmallRun<Device> run(device, number, work, work != Work::increase);
  for (int batch = 0; batch < 40; ++batch) {
    SCOPED_TRACE(batch);
    if (batch % 5 == 0) run.change(1 + batch / 5);
    run.batch((batch + number) % 7);
  }
}

class RunsTogether : public InEachPlace {
 protected:
  template <class Device>
  static const Device& of(const AnyDevice& device) {
    if constexpr (Device::is_gpu) {
      return device.gpu();
    } else {
      return device.cpu();
    }
  }

  /// One run of each kind of work, each in a thread of its own, all at once.
  template <class Device>
  static void run_all(const std::vector<Work>& works) {
    std::vector<AnyDevice> devices;
    for (std::size_t k = 0; k < works.size(); ++k) devices.emplace_back(Device::make());
    share_starts(devices);
    std::vector<std::jthread> threads;
    for (std::size_t k = 0; k < works.size(); ++k)
      threads.emplace_back([&, k] { run<Device>(of<Device>(devices[k]), static_cast<int>(k), works[k]); });
  }
  static void run_all(const std::vector<Work>& works) {
#if TALUS_FOR_GPU
    if (GetParam() == On::gpu) return run_all<GpuDevice>(works);
#endif
    run_all<CpuDevice>(works);
  }
};

TEST_P(RunsTogether, do_what_each_would_do_alone) { run_all(std::vector<Work>(40, Work::add_and_double)); }

TEST_P(RunsTogether, do_not_mind_others_that_do_something_else) {
  std::vector<Work> works;
  for (int k = 0; k < 24; ++k) works.push_back(static_cast<Work>(k % 4));
  run_all(works);
}

TEST_P(RunsTogether, may_be_as_few_as_two) { run_all({Work::add, Work::add}); }

TEST_P(RunsTogether, do_not_leave_a_kernel_out) {
#if TALUS_FOR_GPU
  if (GetParam() == On::cpu) return;  // does all as it is given
  const std::vector<AnyDevice> devices{AnyDevice(GpuDevice::make()), AnyDevice(GpuDevice::make())};
  share_starts(devices);
  SmallRun<GpuDevice> run(devices[0].gpu(), 1, Work::increase, true);
  run.batch(1);  // the first is done as it is
  EXPECT_THROW(run.batch(1), std::logic_error);
#endif
}

TALUS_IN_EACH_PLACE(RunsTogether);

void start_nothing(const LaunchShape&, const LaunchTable&) {}
void start_other(const LaunchShape&, const LaunchTable&) {}

TEST(RunsWithOthers, is_what_a_kernel_or_what_it_wraps_says) {
  EXPECT_TRUE(runs_with_others<AddIndex>());
  EXPECT_FALSE(runs_with_others<Increase>());
  struct Wrapper {
    using Named = AddIndex;
  };
  EXPECT_TRUE(runs_with_others<Wrapper>());
}

TEST(LaunchList, is_alike_where_kinds_and_order_are) {
  LaunchList a, b;
  EXPECT_TRUE(a.is_alike(b));
  a.add(Double{}, 3, 32, start_nothing);
  b.add(Double{}, 5, 32, start_nothing);
  EXPECT_TRUE(a.is_alike(b)) << "the number of blocks is each run's own";
  a.add(Double{}, 3, 32, start_nothing);
  EXPECT_FALSE(a.is_alike(b));
  b.add(Double{}, 3, 64, start_nothing);
  EXPECT_FALSE(a.is_alike(b)) << "all blocks of a start have the same number of threads";
  b.clear();
  b.add(Double{}, 3, 32, start_nothing);
  b.add(Double{}, 3, 32, start_other);
  EXPECT_FALSE(a.is_alike(b));
}

TEST(LaunchList, keeps_the_bytes_of_every_kernel) {
  LaunchList list;
  int here = 0;
  list.add(Double{}, 1, 32, start_nothing);
  list.add(AddIndex{nullptr, &here, 5}, 9, 32, start_nothing);
  AddIndex kept{};
  std::memcpy(static_cast<void*>(&kept), list.kernel(1), sizeof kept);
  EXPECT_EQ(kept.numbers, &here);
  EXPECT_EQ(kept.amount, 5);
  EXPECT_EQ(list.launches()[1].blocks, 9);
  EXPECT_EQ(list.left_out(), nullptr);
  list.leave_out("here");
  EXPECT_STREQ(list.left_out(), "here");
  list.clear();
  EXPECT_EQ(list.left_out(), nullptr);
}

}  // namespace
}  // namespace talus::solver::testing
