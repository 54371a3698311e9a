// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The terrains of data_samples/hard_terrains.hpp mirrored and turned: the slide must not know how its map lies.
#include <cmath>
#include <cstdio>
#include <utility>

#include "tests/solver/samples/sample_scene.hpp"

namespace talus::solver::testing {
namespace {

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
