// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two solvers of one process, each on a device of its own: neither sees the other.
#include "solver/parallel/device.hpp"

#include <cstdio>
#include <thread>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/any_device.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"
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

}  // namespace
}  // namespace talus::solver::testing
