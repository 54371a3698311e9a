// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Arrays on devices, their sorts and sums, atomic updates; solvers on devices of their own, and --profile.
#include <cstdio>
#include <numeric>
#include <random>
#include <thread>

#include "solver/parallel/algorithms.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/parallel/device.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/run/run_stage.hpp"
#include "tests/solver/expect.hpp"
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
TALUS_IN_EACH_PLACE(BufferOn);

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

TEST(Sorting, is_stable_and_sums_are_inclusive_on_the_cpu) {
  std::mt19937 engine(5);
  std::vector<std::uint64_t> keys(10000);
  for (auto& key : keys) key = engine() % 97;
  std::vector<int> expected(keys.size());
  std::iota(expected.begin(), expected.end(), 0);
  std::stable_sort(expected.begin(), expected.end(),
                   [&](int a, int b) { return keys[static_cast<std::size_t>(a)] < keys[static_cast<std::size_t>(b)]; });
  const CpuDevice device = CpuDevice::make();
  Buffer<std::uint64_t, CpuDevice> sorted(device);
  Buffer<int, CpuDevice> order(device);
  sorted.upload(keys);
  sort_order(device, sorted, order);
  EXPECT_EQ(order.download(), expected);
  const std::vector<int> values{3, 0, 5, 1};
  std::vector<int> sums(4);
  EXPECT_EQ(inclusive_sum(device, values.data(), sums.data(), 4), 9);
  EXPECT_EQ(sums, (std::vector<int>{3, 3, 8, 9}));
}

constexpr int count = 10000;

/// Every whole number below `count` once, in no order.
int value(int i) { return i * 7919 % count; }

struct Totals {
  double sum = 0;
  int least = count, most = -1, times = 0, flag = 0, first = -1;
  std::uint32_t largest_bits = 0;
};

/// One thread: one value.
struct Collect {
  Totals* totals;
  void operator()(int i) const {
    atomic_add(&totals->sum, value(i));
    atomic_min(&totals->least, value(i));
    atomic_max(&totals->most, value(i));
    atomic_increment(&totals->times);
    atomic_max_positive(&totals->largest_bits, 1e-3f * static_cast<float>(value(i)));
    replace_if(&totals->first, -1, value(i));
    if (value(i) == 77) raise_flag(&totals->flag, 3);
  }
};

TEST(Atomics, lose_no_update_of_any_thread) {
  Totals totals;
  for_each(CpuDevice::make(), count, Collect{&totals});
  EXPECT_EQ(totals.sum, 0.5 * count * (count - 1)) << "whole numbers, so that every order has the same sum";
  EXPECT_EQ(totals.least, 0);
  EXPECT_EQ(totals.most, count - 1);
  EXPECT_EQ(totals.times, count);
  EXPECT_EQ(positive_from_bits(totals.largest_bits), 1e-3f * (count - 1));
  EXPECT_EQ(totals.flag, 3);
}

TEST(Atomics, replace_only_what_is_expected) {
  int at = -1;
  replace_if(&at, -1, 5);
  EXPECT_EQ(at, 5);
  replace_if(&at, -1, 7);
  EXPECT_EQ(at, 5);
}

TEST(Atomics, leave_what_is_already_as_large_or_as_small) {
  int at = 4;
  atomic_min(&at, 6);
  EXPECT_EQ(at, 4);
  atomic_max(&at, 2);
  EXPECT_EQ(at, 4);
}

TEST(Atomics, scatter_mass_and_momentum_into_their_places) {
  Vec4<double> node{1, 2, 3, 4};
  const double w = node.w, x = node.x, y = node.y, z = node.z;
  scatter_add(&node, Four<double>(10, {20, 30, 40}));
  EXPECT_EQ(node.w, w + 10);
  expect_near(node, {x + 20, y + 30, z + 40}, 0);
}

/// A heap on a slope, and the steps it takes.
struct Slide {
  SolveOptions options;
  Scene scene;
  Slide(Integrator integrator, double slope) {
    Domain d = ground(24, 16, 1.0, 1.0, [=](double x, double y) { return slope * x + 0.1 * y; });
    fill(d, {10, 16, 5, 11, 0, 2});
    options.integrator = integrator;
    options.material.youngs_modulus = 1e6;
    options.implicit.step = 0.02;
    options.deterministic = true;
    scene = make_scene(d, options);
  }
  double end() const { return options.integrator == Integrator::explicit_ ? 0.5 : 0.1; }  // [s]
  std::unique_ptr<Solver> on(const AnyDevice& device) const { return make_solver(scene, options, device); }
  SolverState alone_on(const AnyDevice& device) const {
    const auto solver = on(device);
    run_to(*solver, end());
    return solver->state();
  }
};

/// Every number of two states is the same.
void expect_same(const SolverState& a, const SolverState& b) {
  EXPECT_EQ(a.clock.step, b.clock.step);
  EXPECT_EQ(a.clock.time, b.clock.time);
  expect_same_points(a.points, b.points);
  EXPECT_EQ(a.maps.peak_speed, b.maps.peak_speed);
  EXPECT_EQ(a.maps.peak_thickness, b.maps.peak_thickness);
  EXPECT_EQ(a.maps.arrival_time, b.maps.arrival_time);
}

/// A batch of the one and a batch of the other by turns.
void interleave(Solver& first, Solver& second, double end) {
  first.set_next_event(end);
  second.set_next_event(end);
  bool first_ended = false, second_ended = false;
  while (!first_ended || !second_ended) {
    if (!first_ended) first_ended = first.advance().clock.alarms.halt == at_event;
    if (!second_ended) second_ended = second.advance().clock.alarms.halt == at_event;
  }
}

/// Both ways of running two at a time, on two devices.
void expect_bits_of_each_alone(Integrator integrator, const AnyDevice& first, const AnyDevice& second) {
  const Slide steep(integrator, 0.5), gentle(integrator, 0.3);
  const SolverState steep_alone = steep.alone_on(first), gentle_alone = gentle.alone_on(second);
  EXPECT_NE(steep_alone.points.offset[0], gentle_alone.points.offset[0]) << "two slides that can be told from another";
  {
    SCOPED_TRACE("by turns");
    const auto a = steep.on(first), b = gentle.on(second);
    interleave(*a, *b, steep.end());
    expect_same(a->state(), steep_alone);
    expect_same(b->state(), gentle_alone);
  }
  {
    SCOPED_TRACE("from two threads");
    SolverState a, b;
    std::thread other([&] { b = gentle.alone_on(second); });
    a = steep.alone_on(first);
    other.join();
    expect_same(a, steep_alone);
    expect_same(b, gentle_alone);
  }
}

class TwoDevices : public InEachPlace {};
TALUS_IN_EACH_PLACE(TwoDevices);

TEST_P(TwoDevices, give_explicit_slides_the_bits_of_each_alone) {
  expect_bits_of_each_alone(Integrator::explicit_, make_device(GetParam()), make_device(GetParam()));
}

TEST_P(TwoDevices, give_implicit_slides_the_bits_of_each_alone) {
  expect_bits_of_each_alone(Integrator::newmark, make_device(GetParam()), make_device(GetParam()));
}

TEST_P(TwoDevices, count_their_own_kernels_and_no_others) {
  const AnyDevice counted = make_device(GetParam()), other = make_device(GetParam());
  const Slide slide(Integrator::explicit_, 0.3);
  const auto alone = slide.on(counted);
  counted.profile().turn_on();
  run_to(*alone, slide.end());
  const auto calls = [&] {
    std::vector<std::pair<std::string, long>> all;
    for (const auto& k : counted.profile().kernels()) all.emplace_back(k.name, k.calls);
    return all;
  };
  const auto before = calls();
  EXPECT_FALSE(before.empty());
  const auto beside = slide.on(other);
  run_to(*beside, slide.end());
  EXPECT_EQ(calls(), before);
  EXPECT_TRUE(other.profile().kernels().empty()) << "profiles are off until they are turned on";
}

TEST(TwoGpus, give_slides_the_bits_of_each_alone) {
  if (GpuDevice::count() < 2) GTEST_SKIP() << "fewer than two GPUs on this machine: two streams of one were tested";
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark})
    expect_bits_of_each_alone(integrator, GpuDevice::make(0), GpuDevice::make(1));
}

TEST(Devices, are_handles_to_one_state) {
  const CpuDevice device = CpuDevice::make(), other = CpuDevice::make();
  CpuDevice handle = other;
  handle = device;
  EXPECT_EQ(&device.profile(), &handle.profile());
  EXPECT_NE(&device.profile(), &other.profile());
  EXPECT_FALSE(AnyDevice(device).is_gpu());
  EXPECT_EQ(&AnyDevice(device).profile(), &device.profile());
}

struct Plain {};
template <class Inner>
struct Wrapped {
  using Named = Inner;
};

TEST(KernelNames, are_those_of_their_types) {
  EXPECT_EQ(kernel_name<Plain>(), "Plain");
  EXPECT_EQ(kernel_name<Wrapped<Plain>>(), "Plain");
  EXPECT_EQ((kernel_name<std::pair<Plain, int>>()), "pair");
}

class ProfileOf : public InEachPlace {};
TALUS_IN_EACH_PLACE(ProfileOf);

TEST_P(ProfileOf, a_slide_names_its_kernels_and_takes_no_longer_than_the_run) {
  const AnyDevice device = make_device(GetParam());
  Profile& profile = device.profile();
  const auto calls_of = [&](const std::string& name) {
    long calls = 0;
    for (const auto& k : profile.kernels()) calls += k.name == name ? k.calls : 0;
    return calls;
  };
  const auto seconds_of = [](const auto& entries) {
    double sum = 0;
    for (const auto& e : entries) sum += e.seconds;
    return sum;
  };
  Domain domain = filled(ground(24, 16, 1, 1, [](double x, double) { return 0.3 * x; }), {8, 14, 5, 11, 0, 4});
  const SolveOptions options;
  const auto solver = make_solver(make_scene(domain, options), options, device);
  solver->set_next_event(1e9);
  const long gathers = calls_of("GridToParticle");
  const double phases = seconds_of(profile.phases()), kernels = seconds_of(profile.kernels());
  profile.turn_on();
  const auto begun = std::chrono::steady_clock::now();
  std::int64_t steps = solver->clock().step;
  while (solver->clock().step < steps + 30) solver->advance();
  const double wall = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
  profile.turn_off();
  steps = solver->clock().step - steps;
  EXPECT_GE(calls_of("GridToParticle") - gathers, steps) << "a batch may start more steps than it takes";
  EXPECT_LT(seconds_of(profile.phases()) - phases, 1.01 * wall);
  EXPECT_LT(seconds_of(profile.kernels()) - kernels, 1.01 * wall);
  EXPECT_GT(seconds_of(profile.kernels()) - kernels, 0);
  const auto gather = std::find_if(profile.kernels().begin(), profile.kernels().end(),
                                   [](const auto& k) { return k.name == "GridToParticle"; });
  // Position twice, velocities, strain and volume twice, the home key: 12 B + 46 numbers + 8 B; and the nodes.
  EXPECT_GT(gather->bytes / static_cast<double>(gather->calls),
            static_cast<double>(solver->particle_count()) * (2 * 12 + 32 * 8 + 8));
  EXPECT_EQ(profile.phases()[gather->phase].name, "grid to points");
  const std::string csv = profile_csv(profile, 1e9);
  EXPECT_NE(csv.find("ParticleToGrid,points to grid,"), std::string::npos) << csv;
  double shares = 0;
  for (const auto& [owner, bytes] : solver->memory()) shares += static_cast<double>(bytes);
  EXPECT_EQ(shares, static_cast<double>(solver->bytes()));
}

TEST(CopyBandwidth, is_that_of_a_memory) {
  const double copy = copy_bandwidth(CpuDevice::make());
  EXPECT_GT(copy, 1e8);
  EXPECT_LT(copy, 1e13);
}

}  // namespace
}  // namespace talus::solver::testing
