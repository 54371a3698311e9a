// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/obstacle/obstacles.hpp"

#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

/// Ground that rises by a fifth towards the east.
Raster tilted() {
  return test::raster_of({40, 30, 1000, 2000, 2, ""}, [](double x, double) { return 100 + 0.2 * x; });
}

BodySurface stood(const test::Scratch& scratch, const ObstacleOptions& o) {
  write_level_sets(scratch / "obstacles.vdb", upright_obstacles({o}, tilted(), 4), 0.25);
  return read_level_set(scratch / "obstacles.vdb", o.name, {1, 1, 1});
}

using Obstacles = test::InScratch;

TEST_F(Obstacles, stand_on_their_polygons_with_holes_and_follow_the_ground) {
  ObstacleOptions o;
  o.name = "house";
  o.height = 6;
  o.polygons = test::write_polygon(scratch, "house.csv",
                                   "POLYGON((1020 2020,1040 2020,1040 2030,1020 2030,1020 2020),(1025 2023,1035 "
                                   "2023,1035 2027,1025 2027,1025 2023))");
  const BodySurface surface = stood(scratch, o);
  EXPECT_NEAR(surface.volume, (20 * 10 - 10 * 4) * (6 + 4), 0.03 * 1600);  // edges are rounded by a voxel
  EXPECT_NEAR(surface.low[0], 1020, 0.25);
  EXPECT_NEAR(surface.high[1], 2030, 0.25);
  // The top is parallel to the ground.
  double top_area = 0;
  for (const Facet& f : surface.facets) {
    if (!(f.area[2] > 0) || f.area[2] < 3 * std::abs(f.area[0])) continue;
    top_area += f.area[2];
    const bool inside = f.centre[0] > 1021 && f.centre[0] < 1024 && f.centre[1] > 2021 && f.centre[1] < 2029;
    if (inside) {
      EXPECT_NEAR(f.centre[2], 100 + 0.2 * f.centre[0] + 6, 0.02);
    }
  }
  EXPECT_NEAR(top_area, 160, 16);
}

TEST_F(Obstacles, need_a_height_and_ground_under_them) {
  ObstacleOptions o;
  o.name = "house";
  o.polygons = test::write_polygon(scratch, "house.csv", "POLYGON((1020 2020,1040 2020,1040 2030,1020 2020))");
  EXPECT_TRUE(test::holds(data_fault([&] { stood(scratch, o); }), {"has no positive number \"height\""}));
  o.height = 6;
  o.polygons = test::write_polygon(scratch, "off.csv", "POLYGON((900 2020,1040 2020,1040 2030,900 2020))");
  EXPECT_TRUE(test::holds(data_fault([&] { stood(scratch, o); }), {"where there is no ground"}));
}

}  // namespace
}  // namespace talus::preprocess
