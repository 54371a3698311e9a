// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's numbers as attributes of polygons.
#include "preprocess/scene/bed_zones.hpp"

#include <cmath>
#include <fstream>
#include <numbers>

#include "common/domain/bed_numbers.hpp"
#include "tests/common/scratch.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using Bed = std::vector<std::pair<std::string, Raster>>;

Raster plain() {
  return test::raster_of(test::grid_of(20, 10, 10), [](double, double) { return 1000; });
}

/// A rectangle in cells of the ground from its south-west corner, as WKT.
std::string cells(const MapGrid& grid, double west, double south, double east, double north) {
  const auto x = [&](double c) { return grid.west + c * grid.cell; };
  const auto y = [&](double c) { return grid.south + c * grid.cell; };
  return fmt::format("\"POLYGON(({0} {1},{2} {1},{2} {3},{0} {3},{0} {1}))\"", x(west), y(south), x(east), y(north));
}

std::filesystem::path write_table(const test::Scratch& scratch, const std::string& text) {
  auto file = scratch / "zones.csv";
  std::ofstream(file) << text;
  return file;
}

double number_at(const Bed& bed, const std::string& name, int column, int row) {
  for (const auto& [other, raster] : bed) {
    if (other == name) return raster.at(column, row);
  }
  return -1;
}
double tangent(double angle) { return std::tan(angle * std::numbers::pi / 180); }

TEST(BedPolygons, give_the_numbers_that_their_attributes_are_called_after) {
  const test::Scratch scratch;
  const Raster ground = plain();
  const auto file =
      write_table(scratch, "name,friction_angle_deg,turbulence_m_s2,cohesion_Pa,owner,WKT\nforest,28,400,,7," +
                               cells(ground.grid, 0, 0, 5.5, 10) + "\nmeadow,20,,150,8," +
                               cells(ground.grid, 5.5, 0, 10, 10) + "\n");
  Bed bed;
  lay_bed_polygons(file, ground, bed);
  ASSERT_EQ(bed.size(), 3U) << "owner is no number of the bed";
  EXPECT_NEAR(number_at(bed, "friction_angle_deg", 2, 5), 28, 1e-12);
  EXPECT_NEAR(number_at(bed, "friction_angle_deg", 8, 5), 20, 1e-12);
  EXPECT_NEAR(tangent(number_at(bed, "friction_angle_deg", 5, 5)), 0.5 * (tangent(28) + tangent(20)), 1e-12);
  EXPECT_TRUE(std::isnan(number_at(bed, "friction_angle_deg", 12, 5))) << "the recipe's number";
  EXPECT_NEAR(number_at(bed, "turbulence_m_s2", 2, 5), 400, 1e-9);
  EXPECT_TRUE(std::isnan(number_at(bed, "turbulence_m_s2", 8, 5))) << "left empty";
  EXPECT_NEAR(number_at(bed, "cohesion_Pa", 8, 5), 150, 1e-12);
}

TEST(BedPolygons, lie_over_rasters_by_the_part_that_they_cover) {
  const test::Scratch scratch;
  const Raster ground = plain();
  const auto file = write_table(scratch, "turbulence_m_s2,WKT\n400," + cells(ground.grid, 0, 0, 4.25, 10) + "\n");
  Bed bed{{"turbulence_m_s2", test::raster_of(ground.grid, [](double, double) { return 2000; })}};
  lay_bed_polygons(file, ground, bed);
  EXPECT_NEAR(1 / number_at(bed, "turbulence_m_s2", 4, 5), 0.25 / 400 + 0.75 / 2000, 1e-12) << "the drag is the mean";
  EXPECT_NEAR(number_at(bed, "turbulence_m_s2", 6, 5), 2000, 1e-9);
}

TEST(BedPolygons, are_found_by_what_a_shapefile_leaves_of_a_name) {
  EXPECT_EQ(bed_number_of("friction_a"), "friction_angle_deg");
  EXPECT_EQ(bed_number_of("turbulence"), "turbulence_m_s2");
  EXPECT_EQ(bed_number_of("friction"), "");
  for (const std::string_view number : bed_numbers) {
    EXPECT_EQ(bed_number_of(number), number);
    if (number.size() > 10) {
      EXPECT_EQ(bed_number_of(number.substr(0, 10)), number) << "two keys begin alike";
    }
  }
}

TEST(BedPolygons, that_cannot_be_are_refused_by_feature_and_field) {
  const test::Scratch scratch;
  const Raster ground = plain();
  const auto fault = [&](const std::string& head, const std::string& first, const std::string& second) {
    const auto file = write_table(scratch, head + ",WKT\n" + first + "," + cells(ground.grid, 0, 0, 4, 10) + "\n" +
                                               second + "," + cells(ground.grid, 3.5, 0, 8, 10) + "\n");
    Bed bed;
    return test::fault_of<DataError>([&] { lay_bed_polygons(file, ground, bed); });
  };
  EXPECT_NE(fault("name,friction_angle_deg", "a,20", "scree,95").find("polygon 2 (\"scree\"): friction_angle_deg = 95"),
            std::string::npos);
  EXPECT_NE(fault("turbulence_m_s2", "0", "400").find("polygon 1: turbulence_m_s2 = 0"), std::string::npos);
  EXPECT_NE(fault("cohesion_Pa", "100", "-1").find("polygon 2: cohesion_Pa = -1"), std::string::npos);
  EXPECT_NE(fault("friction_angle_deg", "20", "steep").find("feature 2: friction_angle_deg = \"steep\""),
            std::string::npos);
  EXPECT_NE(fault("friction", "20", "30").find("no attribute of its polygons is a number of the bed"),
            std::string::npos);
  EXPECT_NE(fault("friction_angle_deg", "20", "30").find("ground that two polygons cover"), std::string::npos);
}

}  // namespace
}  // namespace talus::preprocess
