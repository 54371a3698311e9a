// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers of one process on devices of their own, and --profile: every kernel of a step by its name.
#include "solver/parallel/device.hpp"

#include <cstdio>
#include <thread>

#include "solver/parallel/any_device.hpp"
#include "solver/parallel/bandwidth.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/run/profile_report.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

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
  ASSERT_EQ(a.points.id, b.points.id);
  for (int q = 0; q < 3; ++q) {
    EXPECT_EQ(a.points.cell[q], b.points.cell[q]);
    EXPECT_EQ(a.points.offset[q], b.points.offset[q]);
    EXPECT_EQ(a.points.velocity[q], b.points.velocity[q]);
  }
  for (int q = 0; q < 6; ++q) EXPECT_EQ(a.points.elastic[q], b.points.elastic[q]);
  for (int q = 0; q < 9; ++q) EXPECT_EQ(a.points.affine[q], b.points.affine[q]);
  EXPECT_EQ(a.points.log_volume, b.points.log_volume);
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

TALUS_IN_EACH_PLACE(TwoDevices);

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
  Domain domain = ground(24, 16, 1, 1, [](double x, double) { return 0.3 * x; });
  fill(domain, {8, 14, 5, 11, 0, 4});
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
  // Position twice, velocity and affine velocity, strain and volume twice, the home key: 12 B + 46 numbers + 8 B; and
  // the nodes.
  EXPECT_GT(gather->bytes / static_cast<double>(gather->calls),
            static_cast<double>(solver->particle_count()) * (2 * 12 + 32 * 8 + 8));
  EXPECT_EQ(profile.phases()[gather->phase].name, "grid to points");
  const std::string csv = profile_csv(profile, 1e9);
  EXPECT_NE(csv.find("ParticleToGrid,points to grid,"), std::string::npos) << csv;
  double shares = 0;
  for (const auto& [owner, bytes] : solver->memory()) shares += static_cast<double>(bytes);
  EXPECT_EQ(shares, static_cast<double>(solver->bytes()));
}

TALUS_IN_EACH_PLACE(ProfileOf);

TEST(CopyBandwidth, is_that_of_a_memory) {
  const double copy = copy_bandwidth(CpuDevice::make());
  EXPECT_GT(copy, 1e8);
  EXPECT_LT(copy, 1e13);
}

}  // namespace
}  // namespace talus::solver::testing
