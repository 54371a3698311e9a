// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/terrain/scattered.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/read_raster.hpp"

#include "preprocess/terrain/geo_input.hpp"
#include "preprocess/terrain/point_table.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

using test::fault_of;
using test::Scratch;

ScatteredPoints random_points(const MapGrid& grid, int count, std::mt19937& random) {
  std::uniform_real_distribution<double> part(0, 1);
  ScatteredPoints points;
  const double width = grid.columns * grid.cell, height = grid.rows * grid.cell;
  const auto add = [&](double u, double v) {
    points.x.push_back(grid.west + u * width);
    points.y.push_back(grid.south + v * height);
    points.z.push_back(0);
  };
  for (double u : {0.0, 1.0}) add(u, 0), add(u, 1);  // the corners, so that the hull covers the grid
  for (int i = 0; i < count; ++i) add(part(random), part(random));
  return points;
}

TEST(scattered, is_exact_for_a_plane) {
  TALUS_SEEDED(seed);
  std::mt19937 random(seed);
  const MapGrid grid = test::grid_of(40, 30, 5);
  ScatteredPoints points = random_points(grid, 300, random);
  const auto plane = [&](double x, double y) { return 700 + 0.31 * (x - grid.west) - 0.12 * (y - grid.south); };
  for (std::size_t i = 0; i < points.x.size(); ++i) points.z[i] = plane(points.x[i], points.y[i]);
  const Raster raster = interpolate_scattered(points, grid, "points.csv");
  const Raster exact = test::raster_of(grid, plane);
  for (std::size_t i = 0; i < raster.values.size(); ++i) ASSERT_NEAR(raster.values[i], exact.values[i], 1e-8);
}

TEST(scattered, converges_to_a_smooth_surface) {
  TALUS_SEEDED(seed);
  std::mt19937 random(seed);
  const MapGrid grid = test::grid_of(40, 40, 5);
  const auto surface = [&](double x, double y) {
    return 30 * std::sin((x - grid.west) / 40) * std::cos((y - grid.south) / 50);
  };
  const Raster exact = test::raster_of(grid, surface);
  const auto rms_error = [&](int count) {
    ScatteredPoints points = random_points(grid, count, random);
    for (std::size_t i = 0; i < points.x.size(); ++i) points.z[i] = surface(points.x[i], points.y[i]);
    const Raster raster = interpolate_scattered(points, grid, "points.csv");
    double sum = 0;
    for (std::size_t i = 0; i < raster.values.size(); ++i) sum += std::pow(raster.values[i] - exact.values[i], 2);
    return std::sqrt(sum / static_cast<double>(raster.values.size()));
  };
  // Linear interpolation: the error falls with the square of the spacing, so to a sixteenth for 16 times the points. A
  // random net scatters; a third of that is asked.
  const double coarse = rms_error(250), fine = rms_error(4000);
  EXPECT_LT(fine, coarse / 5);
}

TEST(scattered, leaves_places_outside_the_hull_without_value) {
  const MapGrid grid = test::grid_of(10, 10, 1, 0, 0);
  const ScatteredPoints points{{0, 10, 0}, {0, 0, 10}, {1, 1, 1}, ""};
  const Raster raster = interpolate_scattered(points, grid, "points.csv");
  EXPECT_DOUBLE_EQ(raster.at(0, 0), 1);
  EXPECT_TRUE(std::isnan(raster.at(9, 9)));
}

TEST(scattered, averages_points_at_one_place) {
  const MapGrid grid = test::grid_of(1, 1, 1, 0, 0);
  const ScatteredPoints points{{0, 2, 0, 0}, {0, 0, 2, 0}, {1, 4, 4, 7}, ""};
  EXPECT_NEAR(interpolate_scattered(points, grid, "points.csv").at(0, 0), 4, 1e-12);
}

TEST(scattered, refuses_points_on_one_line) {
  const ScatteredPoints points{{0, 1, 2, 2}, {0, 1, 2, 2}, {1, 2, 3, 3}, ""};
  EXPECT_EQ(fault_of<DataError>([&] { interpolate_scattered(points, test::grid_of(2, 2, 1, 0, 0), "points.csv"); }),
            "points.csv: 4 points in 3 places (a surface needs three that do not lie on one line). Give more points, "
            "or a raster");
}

TEST(point_table, reads_columns_by_name_in_any_order) {
  Scratch scratch;
  const auto file = scratch.write("p.csv", "id,Elevation,Easting,Northing\n1,100.5,10,20\n2,101,11,21\n");
  ASSERT_TRUE(is_point_file(file));
  const ScatteredPoints points = read_points(file);
  EXPECT_EQ(points.x, (std::vector<double>{10, 11}));
  EXPECT_EQ(points.y, (std::vector<double>{20, 21}));
  EXPECT_EQ(points.z, (std::vector<double>{100.5, 101}));
}

TEST(point_table, knows_units_behind_the_names_of_columns) {
  Scratch scratch;
  const auto file = scratch.write("p.csv", "X (m); Y (m); Elevation (ft)\n10;20;100\n");
  const ScatteredPoints given = read_points_as_given(file);
  EXPECT_EQ(given.unit, "ft");
  EXPECT_EQ(given.y, std::vector<double>{20});
  EXPECT_NEAR(read_points(file).z.front(), 30.48, 1e-12);
  EXPECT_NEAR(read_points(file, {"", "metre", ""}).z.front(), 30.48, 1e-12);
  EXPECT_NEAR(read_points(scratch.write("q.csv", "x,y,z\n1,2,100\n"), {"", "foot", ""}).z.front(), 30.48, 1e-12);
  EXPECT_EQ(height_name("Z_US_ft")->unit, "us ft");
  for (const char* name : {"depth of bedrock", "depth_error_m", "zone", "height_s", "x"})
    EXPECT_FALSE(height_name(name)) << name;
}

TEST(point_table, takes_no_depths_for_elevations) {
  Scratch scratch;
  EXPECT_TRUE(
      test::holds(fault_of<DataError>([&] { read_points(scratch.write("p.csv", "x,y,depth\n1,2,3\n")); }), {"line 1"}));
  const ScatteredPoints both = read_points(scratch.write("q.csv", "x,y,z,depth\n1,2,3,4\n"));
  EXPECT_EQ(both.z, std::vector<double>{3});
  EXPECT_FALSE(both.are_depths);
}

TEST(point_table, reads_blanks_semicolons_and_comments) {
  Scratch scratch;
  const auto file = scratch.write("p.xyz", "# surveyed\n1 2\t3\n\n4;5;6  # last\r\n9.5 1e3 -2\n");
  ASSERT_TRUE(is_point_file(file));
  EXPECT_EQ(read_points(file).z, (std::vector<double>{3, 6, -2}));
}

TEST(point_table, names_the_line_that_is_not_three_numbers) {
  Scratch scratch;
  const auto file = scratch.write("p.csv", "x,y,z\n1,2,3\n1,two,3\n");
  EXPECT_EQ(fault_of<DataError>([&] { read_points(file); }),
            file.string() +
                ": line 3: \"1,two,3\" (not three numbers x, y, z). Mend the line, or name the columns x,y,z in a "
                "first line");
}

TEST(point_file, reads_vector_points_with_elevation) {
  Scratch scratch;
  const auto file = scratch.write(
      "p.geojson",
      R"({"type":"FeatureCollection","crs":{"type":"name","properties":{"name":"urn:ogc:def:crs:EPSG::32633"}},
    "features":[{"type":"Feature","properties":{},"geometry":{"type":"Point","coordinates":[500000,5100000,12.5]}}]})");
  ASSERT_TRUE(is_point_file(file));
  const ScatteredPoints points = read_points(file);
  EXPECT_EQ(points.z, std::vector<double>{12.5});
  EXPECT_TRUE(same_crs(points.crs_wkt, metric_crs("EPSG:32633")));
}

TEST(point_file, refuses_points_in_degrees) {
  Scratch scratch;
  const auto file =
      scratch.write("p.geojson", R"({"type":"FeatureCollection","features":[{"type":"Feature","properties":{},
    "geometry":{"type":"Point","coordinates":[13.5,47.1,12.5]}}]})");
  EXPECT_EQ(fault_of<DataError>([&] { read_points(file); }),
            file.string() +
                ": CRS is EPSG:4326 (this stage needs metres). Reproject: ogr2ogr -t_srs EPSG:32633 p_utm.gpkg " +
                file.string());
}

TEST(point_file, is_not_a_raster) {
  Scratch scratch;
  const auto file =
      test::write(scratch, "dem.tif", test::raster_of(test::grid_of(3, 3, 1), [](double, double) { return 1.0; }));
  EXPECT_FALSE(is_point_file(file));
}

TEST(point_file, is_not_an_ascii_grid_of_whatever_dialect) {
  Scratch scratch;
  const std::string grid = "ncols 2\nnrows 2\nxllcentre 10\nyllcentre 20\ncellsize 5\n1 2\n3 4\n";
  EXPECT_FALSE(is_point_file(scratch.write("dem.txt", grid)));
  EXPECT_FALSE(is_point_file(scratch.write("odd.txt", "# made by hand\n" + grid)));
  EXPECT_EQ(read_raster(scratch / "odd.txt").at(0, 0), 3);
}

TEST(metric_crs, refuses_degrees_and_unknown_names) {
  EXPECT_EQ(fault_of<RecipeError>([] { metric_crs("EPSG:4326"); }),
            "[preprocess]: working_crs = \"EPSG:4326\" (its coordinates are not in metres). Name a projected CRS in "
            "metres, such as "
            "the UTM zone of the place");
  EXPECT_EQ(
      fault_of<RecipeError>([] { metric_crs("EPSG:nought"); }),
      "[preprocess]: working_crs = \"EPSG:nought\" (no such CRS is known). Name it by its code, as in \"EPSG:32633\"");
}

}  // namespace
}  // namespace talus::preprocess
