// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slides on hard terrains: their footprint, over a cliff, and on maps that are mirrored and turned.
#include <cstdio>

#include "tests/solver/samples/sample_scene.hpp"

namespace talus::solver::testing {
namespace {

/// A map of cells twice as wide, cell by cell of the finer one.
std::vector<double> on_half_cells(const std::vector<double>& map, int columns, int rows) {
  std::vector<double> fine;
  for (int j = 0; j < 2 * rows; ++j) {
    for (int i = 0; i < 2 * columns; ++i) fine.push_back(map[static_cast<std::size_t>(j / 2 * columns + i / 2)]);
  }
  return fine;
}

class SampleFootprint : public InEachPlace {
 protected:
  struct Flow {
    const char* name;
    SampleScene scene;
    double end;  ///< [s]
    /// The least share in common with other friction inside, other layers and cells of twice the width.
    double by_friction, by_layers, by_cells;
  };
  static std::vector<double> peak(const SampleScene& scene, double end) {
    SampleRun run(scene, GetParam());
    run.run_to(end);
    return run.peak_thickness();
  }
  /// The share of the footprint that another scene has in common with one [peak thickness of the flow, 0.1 m].
  static double common(const Flow& flow, const std::vector<double>& as_is, const SampleScene& other, const char* what,
                       double value) {
    const double share = common_cover(as_is, peak(other, flow.end), 0.1);
    std::printf("  %s, %s %g: %.3f in common\n", flow.name, what, value, share);
    return share;
  }
  /// Runs a flow again with other friction inside, other layers and other cells.
  static void compare(const Flow& flow) {
    const auto as_is = peak(flow.scene, flow.end);
    SampleScene other = flow.scene;
    for (const double friction : {30.0, 45.0}) {
      other.options.material.friction_angle = friction;
      EXPECT_GT(common(flow, as_is, other, "friction inside", friction), flow.by_friction);
    }
    other = flow.scene;
    other.layer_height *= 2;
    EXPECT_GT(common(flow, as_is, other, "layers", other.layer_height), flow.by_layers);
    other = flow.scene;
    other.cell *= 2;
    SampleRun coarse(other, GetParam());
    coarse.run_to(flow.end);
    const auto there = on_half_cells(coarse.peak_thickness(), coarse.map().columns, coarse.map().rows);
    const double share = common_cover(as_is, there, 0.1);
    std::printf("  %s, cells %g: %.3f in common\n", flow.name, other.cell, share);
    EXPECT_GT(share, flow.by_cells);
  }
};

TEST_P(SampleFootprint, of_a_thin_flow_is_that_of_the_terrain) {
  // A coarse cell counts as covered where a part of it is.
  compare({"rough slope", rough_slope_scene(), 10, 0.97, 0.97, 0.83});
}

TEST_P(SampleFootprint, in_a_gully_is_that_of_the_terrain) {
  // This flow is deeper, and climbs the bends a little otherwise.
  compare({"bent gully", bent_gully_scene(), 16, 0.9, 0.97, 0.8});
}

TALUS_IN_EACH_PLACE(SampleFootprint);

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

struct LaidScene {
  const char* name;
  SampleScene (*scene)();
  double end;  ///< on the way [s]
};
constexpr LaidScene laid_scenes[] = {{"rough slope", rough_slope_scene, 5},
                                     {"bent gully", bent_gully_scene, 14},
                                     {"cliff and bench", cliff_bench_scene, 9},
                                     {"thinning slide", thinning_slide_scene, 30}};

class SampleSymmetry : public InEachPlace {
 protected:
  static SampleRun run_of(const LaidScene& laid, const samples::Pose& pose) {
    SampleScene scene = laid.scene();
    scene.pose = pose;
    return {scene, GetParam()};
  }
  /// The area of the footprint, thicker than 0.1 m at some time [m2].
  static double area_of(const SampleRun& run) {
    double cells = 0;
    for (const double t : run.peak_thickness()) cells += t > 0.1;
    return cells * run.map().cell * run.map().cell;
  }
  /// The largest difference of two runs' thickness over the largest thickness; cell (i, j) of a is cell place(i, j) of
  /// b.
  template <class Place>
  static double difference(const SampleRun& a, const SampleRun& b, const Place& place) {
    const std::vector<double> map = a.thickness(), other = b.thickness();
    double worst = 0, most = 0;
    for (int j = 0; j < a.map().rows; ++j) {
      for (int i = 0; i < a.map().columns; ++i) {
        const auto [column, row] = place(i, j);
        const double t = map[a.map().index(i, j)];
        worst = std::max(worst, std::abs(t - other[b.map().index(column, row)]));
        most = std::max(most, t);
      }
    }
    return worst / most;
  }
};

TEST_P(SampleSymmetry, mirrored_and_quarter_turned_terrain_gives_the_same_slide) {
  for (const LaidScene& laid : laid_scenes) {
    SampleRun as_is = run_of(laid, {}), mirrored = run_of(laid, {true, 0}), turned = run_of(laid, {false, 90});
    for (SampleRun* run : {&as_is, &mirrored, &turned}) run->run_to(laid.end);
    const int rows = as_is.map().rows;
    const double by_mirror = difference(as_is, mirrored, [&](int i, int j) { return std::pair(i, rows - 1 - j); });
    const double by_turn = difference(as_is, turned, [&](int i, int j) { return std::pair(rows - 1 - j, i); });
    std::printf("  %s at %g s: mirrored %.1e, turned %.1e of the largest thickness\n", laid.name, laid.end, by_mirror,
                by_turn);
    // Sums in another order: rounding, grown in the flow.
    EXPECT_LT(by_mirror, 1e-8) << laid.name;
    EXPECT_LT(by_turn, 1e-8) << laid.name;
  }
}

TEST_P(SampleSymmetry, obliquely_turned_terrain_gives_the_same_slide_within_a_cell) {
  for (const LaidScene& laid : laid_scenes) {
    SampleRun as_is = run_of(laid, {}), turned = run_of(laid, {false, 30});
    for (SampleRun* run : {&as_is, &turned}) run->run_to(laid.end);
    const auto a = as_is.points(), b = turned.points();
    const Mean ma = mean_of(a), mb = mean_of(b);
    const double cell = as_is.map().cell, centre = std::hypot(mb.x - ma.x, mb.y - ma.y) / cell;
    const double reach = (reach_of(b, 0.99) - reach_of(a, 0.99)) / cell, area = area_of(turned) / area_of(as_is) - 1;
    const double energy = mb.half_square / ma.half_square - 1;
    std::printf("  %s at %g s: centre %.2f cells, reach %.2f cells, area %.1f %%, kinetic energy %.1f %%\n", laid.name,
                laid.end, centre, reach, 100 * area, 100 * energy);
    EXPECT_LT(centre, 0.2) << laid.name;
    EXPECT_LT(std::abs(reach), 0.75) << laid.name;
    EXPECT_LT(std::abs(area), 0.05) << laid.name;
    if (ma.half_square > 10) {  // while it moves
      EXPECT_LT(std::abs(energy), 0.03) << laid.name;
    }
    EXPECT_NEAR(ma.volume / mb.volume, 1, 0.02) << laid.name;  // the release on other cells
  }
}

TALUS_IN_EACH_PLACE(SampleSymmetry);

}  // namespace
}  // namespace talus::solver::testing
