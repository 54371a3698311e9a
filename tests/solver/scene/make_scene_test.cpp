// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From a domain to a scene: points on the grid that was made for them, or none.
#include "solver/scene/make_scene.hpp"

#include <gtest/gtest.h>

#include "tests/common/scratch.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver {
namespace {

using test::fault_of;

/// Four points in the cells about (5, 5), two layers high, on a slope.
Domain sample() {
  Domain domain = testing::ground(30, 20, 10, 5, [](double x, double) { return 0.3 * x; });
  testing::fill(domain, {50, 60, 50, 60, 0, 10}, 1, 1);
  domain.active = active_cells(domain.grid, domain.layer_height, domain.points);
  return domain;
}

TEST(MakeScene, the_mask_of_the_file_is_the_grid_at_the_start) {
  const Domain domain = sample();
  EXPECT_EQ(make_scene(domain, {}).active, *domain.active);
  Domain made_in_memory = domain;
  made_in_memory.active.reset();
  EXPECT_EQ(make_scene(made_in_memory, {}).active, *domain.active);
}

TEST(MakeScene, every_node_next_to_a_point_is_active) {
  const Scene scene = make_scene(sample(), {});
  for (std::size_t p = 0; p < scene.points.size(); ++p) {
    for (int beside = 0; beside < 27; ++beside) {
      const int layer = scene.points.cell[2][p] + beside / 9 - 1;
      EXPECT_EQ(scene.active.holds(
                    {scene.points.cell[0][p] + beside % 3 - 1, scene.points.cell[1][p] + beside / 3 % 3 - 1, layer}),
                layer >= 0);
    }
  }
}

TEST(MakeScene, points_outside_the_active_cells_are_refused) {
  Domain domain = sample();
  domain.points.height[1] = 40;
  EXPECT_EQ(
      fault_of<DataError>([&] { make_scene(domain, {}); }),
      "domain.vdb: point 1 at (55.00, 55.00), 40.00 m above the bed, lies in column 5, row 5, layer 8, which is no "
      "active cell of the background grid (points and mask \"active\" are not of one domain). Run "
      "talus-preprocess again");
  domain = sample();
  domain.points.x[0] = 215;
  EXPECT_NE(fault_of<DataError>([&] { make_scene(domain, {}); }).find("lies in column 21, row 5, layer 1,"),
            std::string::npos);
}

TEST(MakeScene, points_at_the_edge_of_the_ground_are_refused) {
  Domain domain = sample();
  domain.points.x[0] = 2;
  EXPECT_EQ(fault_of<DataError>([&] { make_scene(domain, {}); }),
            "domain.vdb: point 0 at (2.00, 55.00) stands outside the ground or at its edge (a point needs known ground "
            "one cell around it). Give a larger elevation model, or a smaller source, and run talus-preprocess again");
}

}  // namespace
}  // namespace talus::solver
