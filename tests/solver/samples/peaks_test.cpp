// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of peak speed and pressure hold what points did, and no slide is faster than its fall.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/solver/samples/sample_scene.hpp"

namespace talus::solver::testing {
namespace {

constexpr double gravity = 9.81;

/// A ledge 310 m over a plain, upright but for a cell, and a slab that slides off it: columns of little mass in flight.
Domain upright_cliff() {
  Domain d = ground(56, 16, 10, 5, [](double x, double) { return x < 200 ? 310 + 0.6 * (200 - x) : 0.0; });
  fill(d, {60, 160, 40, 120, 0, 12});
  for (int row = 4; row < 12; ++row) {
    for (int column = 6; column < 16; ++column) d.release_thickness.at(column, row) = 12;
  }
  return d;
}

class SamplePeaks : public InEachPlace {
 protected:
  /// What may be compared of a run at its end.
  struct Peaks {
    double fastest;   ///< of any point at any time [m/s]
    double speed;     ///< largest of the map [m/s]
    double pressure;  ///< largest of the map [Pa]
  };

  static Peaks peaks_of(const Scene& scene, const SolveOptions& o, double end) {
    const auto solver = make_solver(scene, o, GetParam());
    run_to(*solver, end);
    const SolverState state = solver->state();
    // The worst sample has 3.2 over time, and a quarter is to spare (docs/notes/grid-and-transfer.md).
    const Packing packing = solver->packing();
    EXPECT_LT(packing.p99, 4);
    EXPECT_GE(packing.largest, packing.p99);
    expect_below_fall(scene, state.maps.peak_speed);
    const auto largest = [](const std::vector<double>& map) { return *std::max_element(map.begin(), map.end()); };
    return {static_cast<double>(positive_from_bits(state.clock.control.fastest_bits)), largest(state.maps.peak_speed),
            largest(state.maps.peak_pressure)};
  }

  /// Each cell against the fall from the highest point at the start to the ground in it. Less than 20 m below that, a
  /// column's share of points beside it counts for more than its own ground.
  static void expect_below_fall(const Scene& scene, const std::vector<double>& speed) {
    double top = -1e300;
    for (const auto& place : positions(scene, scene.points)) top = std::max(top, place[2]);
    for (std::size_t c = 0; c < speed.size(); ++c) {
      const double drop = top - scene.grid.terrain[c];
      if (!(drop > 20)) continue;
      EXPECT_LE(speed[c], std::sqrt(2 * gravity * drop)) << "cell " << c;
    }
  }

  static void expect_within(const Peaks& peaks, double density, const char* name) {
    std::printf("  %s: fastest point %.2f m/s, map of speed up to %.2f m/s\n", name, peaks.fastest, peaks.speed);
    // The fastest point is kept in single precision: 6e-8.
    const double bound = peaks.fastest * (1 + 1e-6);
    EXPECT_LE(peaks.speed, bound);
    EXPECT_LE(peaks.pressure, density * bound * bound);
    EXPECT_GT(peaks.speed, 0.7 * peaks.fastest) << "the map saw the flow";
  }
};

TEST_P(SamplePeaks, no_cell_of_the_samples_is_faster_than_the_fastest_point_or_its_fall) {
  struct Case {
    const char* name;
    SampleScene (*scene)();
    double end;  ///< [s]
  };
  for (const Case& c :
       {Case{"rough slope", rough_slope_scene, 4}, Case{"bent gully", bent_gully_scene, 5},
        Case{"cliff and bench", cliff_bench_scene, 8}, Case{"thinning slide", thinning_slide_scene, 10}}) {
    for (const Mapping mapping : {Mapping::terrain_following, Mapping::cartesian}) {
      SCOPED_TRACE(c.name);
      SampleScene sample = c.scene();
      sample.options.mapping = mapping;
      const Scene scene = make_scene(domain_of(sample), sample.options);
      expect_within(peaks_of(scene, sample.options, c.end), 2000, c.name);
    }
  }
}

/// Momentum over mass of the columns' nodes had made 193 m/s of points that ran at 83 m/s.
TEST_P(SamplePeaks, no_cell_below_an_upright_cliff_is_faster_than_the_fastest_point_or_its_fall) {
  const Domain domain = upright_cliff();
  for (const Integrator integrator : {Integrator::explicit_, Integrator::newmark}) {
    SolveOptions o;
    o.mapping = Mapping::cartesian;
    o.integrator = integrator;
    o.material.friction_angle = 35;
    o.base.friction_angle = 15;
    o.implicit.step = 0.1;
    o.implicit.newton_tolerance = 1e-3;
    const Scene scene = make_scene(domain, o);
    // Newton's steps of 0.1 s on what falls apart are slow: until half of it is over the edge.
    const double end = integrator == Integrator::explicit_ ? 16 : 8;
    expect_within(peaks_of(scene, o, end), o.material.density, "upright cliff");
  }
}

TALUS_IN_EACH_PLACE(SamplePeaks);

}  // namespace
}  // namespace talus::solver::testing
