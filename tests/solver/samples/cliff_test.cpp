// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A slide that goes over a cliff falls as a stone does, lands on the bench, and goes on below it.
#include <cmath>
#include <cstdio>
#include <map>

#include "tests/solver/samples/sample_scene.hpp"

namespace talus::solver::testing {
namespace {

class SampleCliff : public InEachPlace {
 protected:
  static constexpr double g = 9.81, edge = 150, foot = 160, brink = 210;  ///< along the terrain's own axis [m]

  /// Sums over what falls.
  struct Fall {
    double flying = 0, acceleration = 0;  ///< upward, out of reach of what has landed [m/s2]
    double low = 0, speed_share = 0;      ///< just above that: speed over that of a free fall from the edge
  };

  /// The method adds what fell freely between two instants.
  static void add_flight(const std::vector<PointSeen>& was, const std::vector<PointSeen>& is, double interval,
                         Fall& sums) {
    for (std::size_t p = 0; p < is.size(); ++p) {
      if (was[p].height < 12 || is[p].height < 12 || was[p].x < edge) continue;
      sums.flying += 1;
      sums.acceleration += (is[p].upward - was[p].upward) / interval;
    }
  }
  /// The method notes the energy of what is still on the slope, and adds what has nearly fallen.
  static void add_arrival(const std::vector<PointSeen>& points, std::map<int, double>& at_edge, Fall& sums) {
    for (const PointSeen& p : points) {
      const double energy = 0.5 * p.speed * p.speed + g * p.z;  // per mass
      if (p.x < edge) at_edge[p.id] = energy;
      if (p.x < edge || p.height < 6 || p.height > 9) continue;
      sums.low += 1;
      sums.speed_share += p.speed / std::sqrt(2 * (at_edge.at(p.id) - g * p.z));
    }
  }
  /// The share of the volume between two places.
  static double between(const std::vector<PointSeen>& points, double from, double to) {
    double volume = 0, all = 0;
    for (const PointSeen& p : points) {
      all += p.volume;
      volume += p.x >= from && p.x < to ? p.volume : 0;
    }
    return volume / all;
  }
};

TEST_P(SampleCliff, what_goes_over_a_cliff_falls_freely_and_lands_on_the_bench) {
  SampleRun run(cliff_bench_scene(), GetParam());
  constexpr double interval = 0.1;
  std::map<int, double> at_edge;
  std::vector<PointSeen> was = run.points();
  Fall sums;
  for (int n = 1; n <= 75; ++n) {  // until a heap has grown at the foot
    run.run_to(n * interval);
    const std::vector<PointSeen> is = run.points();
    ASSERT_EQ(is.size(), was.size());
    add_flight(was, is, interval, sums);
    add_arrival(is, at_edge, sums);
    was = is;
  }
  const double acceleration = sums.acceleration / sums.flying, share = sums.speed_share / sums.low;
  std::printf("  in flight %.2f m/s2 (%g sights), above the bench %.3f of the speed of a free fall (%g sights)\n",
              acceleration, sums.flying, share, sums.low);
  EXPECT_GT(sums.flying, 1000);
  EXPECT_NEAR(acceleration, -g, 0.02 * g);
  // The edge, which cells of 5 m round off, costs some speed.
  EXPECT_GT(sums.low, 300);
  EXPECT_GT(share, 0.96);
  EXPECT_LT(share, 1.01);
}

TEST_P(SampleCliff, the_mass_comes_to_lie_on_the_bench_and_below_it) {
  SampleRun run(cliff_bench_scene(), GetParam());
  run.run_to(30);
  const auto end = run.points();
  const double on_bench = between(end, foot, brink), below = between(end, brink, 1e9);
  std::printf("  on the bench %.3f, below it %.3f\n", on_bench, below);
  EXPECT_GT(on_bench, 0.7);
  EXPECT_GT(below, 0.1);
  EXPECT_LT(between(end, 0, foot), 1e-3) << "something hangs on the cliff, or above it";
}

TALUS_IN_EACH_PLACE(SampleCliff);

}  // namespace
}  // namespace talus::solver::testing
