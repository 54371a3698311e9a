// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of a table of the bed's friction, as rasters.
#include "preprocess/scene/bed_zones.hpp"

#include <cmath>
#include <numbers>

#include "tests/common/scratch.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using Bed = std::vector<std::pair<std::string, Raster>>;

/// Ground of 20 by 10 cells of 10 m that rises from 1000 m in the west by 10 m a cell.
Raster rising() {
  const MapGrid grid = test::grid_of(20, 10, 10);
  return test::raster_of(grid, [&](double x, double) { return 1000 + (x - grid.west - 5); });
}

/// The coefficient in a cell of a laid bed.
double mu_at(const Bed& bed, int column, int row) {
  for (const auto& [name, raster] : bed) {
    if (name == "friction_angle_deg") return std::tan(raster.at(column, row) * std::numbers::pi / 180);
  }
  return -1;
}
double xi_at(const Bed& bed, int column, int row) {
  for (const auto& [name, raster] : bed) {
    if (name == "turbulence_m_s2") return raster.at(column, row);
  }
  return -1;
}

Bed laid(const BedRasters& options, Bed bed = {}) {
  lay_bed_zones(options.zones, rising(), bed);
  return bed;
}

TEST(BedZones, hold_between_their_elevations_and_leave_the_rest_to_the_recipe) {
  BedRasters o;
  o.zones.push_back({.to = 1050, .friction_coefficient = 0.3, .turbulence = 1500});
  o.zones.push_back({.from = 1050, .to = 1100, .friction_coefficient = 0.25});
  const Bed bed = laid(o);
  ASSERT_EQ(bed.size(), 2u);
  EXPECT_NEAR(mu_at(bed, 4, 3), 0.3, 1e-12);   // 1040 m
  EXPECT_NEAR(mu_at(bed, 5, 3), 0.25, 1e-12);  // 1050 m
  EXPECT_NEAR(xi_at(bed, 4, 3), 1500, 1e-9);
  EXPECT_TRUE(std::isnan(xi_at(bed, 5, 3)));
  EXPECT_TRUE(std::isnan(mu_at(bed, 10, 3)));
}

TEST(BedZones, add_by_the_part_of_a_cell_that_polygons_cover_and_may_reach_beyond_the_ground) {
  const test::Scratch scratch;
  const Raster ground = rising();
  BedRasters o;
  o.zones.push_back({.friction_coefficient = 0.2, .turbulence = 2000});
  // From far in the south-west to the middle of column 6 and row 5.
  const double east = ground.grid.west + 65, north = ground.grid.south + 55;
  o.zones.push_back(
      {.polygons = test::write_polygon(scratch, "forest.csv",
                                       fmt::format("POLYGON(({0} {1},{2} {1},{2} {3},{0} {3},{0} {1}))",
                                                   ground.grid.west - 9000, ground.grid.south - 9000, east, north)),
       .added_coefficient = 0.04,
       .turbulence = 400});
  const Bed bed = laid(o);
  EXPECT_NEAR(mu_at(bed, 2, 2), 0.24, 1e-12);
  EXPECT_NEAR(mu_at(bed, 6, 2), 0.22, 1e-12) << "half covered";
  EXPECT_NEAR(mu_at(bed, 6, 5), 0.21, 1e-12) << "a quarter";
  EXPECT_NEAR(mu_at(bed, 7, 2), 0.2, 1e-12);
  EXPECT_NEAR(xi_at(bed, 2, 2), 400, 1e-9);
  EXPECT_NEAR(1 / xi_at(bed, 6, 2), 0.5 * (1 / 400.0 + 1 / 2000.0), 1e-12) << "the drag is the mean";
}

TEST(BedZones, lie_over_rasters_and_add_to_nothing_that_is_unknown) {
  const Raster ground = rising();
  BedRasters o;
  o.zones.push_back({.added_coefficient = 0.1});
  const double angle = std::atan(0.2) * 180 / std::numbers::pi;
  const Bed bed =
      laid(o, {{"friction_angle_deg", test::raster_of(ground.grid, [&](double, double) { return angle; })}});
  EXPECT_NEAR(mu_at(bed, 4, 4), 0.3, 1e-12);
  EXPECT_NE(test::fault_of<DataError>([&] { laid(o); }).find("nothing to add to"), std::string::npos);
  o.zones.insert(o.zones.begin(), {.friction_coefficient = 0.05});
  o.zones[1].added_coefficient = -0.1;
  EXPECT_NE(test::fault_of<DataError>([&] { laid(o); }).find("falls below 0"), std::string::npos);
}

TEST(BedZones, reach_the_domain) {
  test::Scene scene;
  scene.options.bed.zones.push_back({.friction_coefficient = 0.4});
  const Domain d = scene.prepare().domain;
  ASSERT_EQ(d.bed.size(), 1u);
  EXPECT_NEAR(mu_at(d.bed, 5, 5), 0.4, 1e-12);
}

TEST(BedZones, say_what_they_need) {
  Options o;
  o.before_dem = "/before.tif";
  o.after_dem = "/after.tif";
  const auto fault_with = [&](const BedZone& zone) {
    o.bed.zones = {zone};
    return test::faults_of(o);
  };
  EXPECT_EQ(fault_with({.friction_coefficient = 0.2}), "");
  EXPECT_NE(fault_with({}).find("gives no number"), std::string::npos);
  EXPECT_NE(fault_with({.from = 5, .to = 4, .turbulence = 1}).find("from_m = 5 is not below"), std::string::npos);
  EXPECT_NE(fault_with({.friction_coefficient = 0.1, .added_coefficient = 0.1}).find("both given"), std::string::npos);
  o.bed.zones = {{.polygons = "/forest.gpkg", .from = 900, .to = 1500, .added_coefficient = 0.02, .turbulence = 400}};
  test::expect_read_as_written(o);
}

}  // namespace
}  // namespace talus::preprocess
