// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sums and maps over particles that are known, and the clock that host and kernels change in turns.
#include "solver/integrator/particle_measures.hpp"

#include <numeric>

#include "solver/integrator/device_state.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

/// A box of 4 x 4 x 1.5 m on cells of 2 m, with everything that measures it.
template <class Device>
struct Bench {
  using Measures = ParticleMeasures<double, Device, Quadratic>;
  Scene scene = make();
  Particles<double, Device> points;
  SparseGrid<double, Device> grid;
  Measures measures;

  static Scene make() {
    Domain d = ground(12, 10, 2.0, 1.0, [](double, double) { return 5.0; });
    fill(d, {8, 12, 6, 10, 0, 1.5});
    SolveOptions o;
    o.initial_velocity = {3, 0, 0};
    return make_scene(d, o);
  }
  explicit Bench(const Device& device)
      : points(device, {}), grid(device, scene.grid, {}), measures(device, scene.grid) {
    points.upload(scene.points);
    grid.fit(points, 0);
  }
};

class ParticleMeasuresOn : public OnEachDevice {
 protected:
  template <class Body>
  static void on_bench(Body&& body) {
    on_device([&](const auto& device) { body(Bench<std::decay_t<decltype(device)>>(device)); });
  }
};

TEST_P(ParticleMeasuresOn, have_the_volume_and_the_momentum_of_the_whole) {
  on_bench([](auto bench) {
    Materials<double> materials;
    materials.list[0].density = 1500;
    using Energy = typename std::decay_t<decltype(bench.measures)>::Energy;
    bench.measures.start_energies(bench.points.count(),
                                  Energy{bench.grid.view(), bench.points.view(), materials, {0, 0, -10}, false});
    const Energies sums = bench.measures.energies();
    EXPECT_NEAR(sums.volume, 24, 1e-12);
    EXPECT_NEAR(sums.momentum.x, 24 * 1500 * 3, 1e-8);
    EXPECT_EQ(sums.momentum.y, 0);
    EXPECT_NEAR(sums.kinetic, 0.5 * 24 * 1500 * 9, 1e-7);
    EXPECT_NEAR(sums.potential, 24 * 1500 * 10 * 0.75, 1e-7);
  });
}

TEST_P(ParticleMeasuresOn, spread_the_whole_volume_over_the_map) {
  on_bench([](auto bench) {
    const std::vector<double> thickness = bench.measures.thickness(bench.points.view(), bench.grid.groups());
    ASSERT_EQ(thickness.size(), 120u);
    EXPECT_NEAR(4 * std::accumulate(thickness.begin(), thickness.end(), 0.0), 24, 1e-12);
    EXPECT_EQ(bench.measures.thickness(bench.points.view(), bench.grid.groups()).size(), 120u);
    const std::vector<double> again = bench.measures.thickness(bench.points.view(), bench.grid.groups());
    for (std::size_t n = 0; n < again.size(); ++n) EXPECT_NEAR(again[n], thickness[n], 1e-13) << "it is made anew";
  });
}

TEST_P(ParticleMeasuresOn, have_volumes_over_columns_once_they_are_measured) {
  on_bench([](auto bench) {
    EXPECT_EQ(bench.measures.column_volumes(), nullptr);
    bench.measures.measure_columns(bench.points.view(), bench.grid.groups());
    std::vector<double> volumes(120);
    copy_to_host(bench.grid.device(), volumes.data(), bench.measures.column_volumes(), 120 * sizeof(double));
    EXPECT_NEAR(std::accumulate(volumes.begin(), volumes.end(), 0.0), 24, 1e-12);
  });
}

TALUS_IN_EACH_PLACE(ParticleMeasuresOn);

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
