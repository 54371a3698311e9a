// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The footprint of a thin flow is the terrain's, not that of the grid or of the friction inside.
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

}  // namespace
}  // namespace talus::solver::testing
