// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <chrono>

#include "common/gis/crs.hpp"
#include "common/gis/raster_file.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "preprocess/terrain/triangulation.hpp"
#include "preprocess/terrain/voids.hpp"
#include "tests/common/geojson.hpp"
#include "tests/preprocess/survey_data.hpp"

namespace talus::preprocess {
namespace {

using test::fault_of;
using test::grid_of;
using test::holds;
using test::raster_of;

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
  test::Seeded random;
  const MapGrid grid = test::grid_of(40, 30, 5);
  ScatteredPoints points = random_points(grid, 300, random);
  const auto plane = [&](double x, double y) { return 700 + 0.31 * (x - grid.west) - 0.12 * (y - grid.south); };
  for (std::size_t i = 0; i < points.x.size(); ++i) points.z[i] = plane(points.x[i], points.y[i]);
  const Raster raster = interpolate_scattered(points, grid, "points.csv");
  const Raster exact = test::raster_of(grid, plane);
  for (std::size_t i = 0; i < raster.values.size(); ++i) ASSERT_NEAR(raster.values[i], exact.values[i], 1e-8);
}

TEST(scattered, converges_to_a_smooth_surface) {
  test::Seeded random;
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

TEST(scattered, leaves_places_outside_the_hull_without_value_and_averages_points_at_one_place) {
  const MapGrid grid = test::grid_of(10, 10, 1, 0, 0);
  const ScatteredPoints points{{0, 10, 0}, {0, 0, 10}, {1, 1, 1}, ""};
  const Raster raster = interpolate_scattered(points, grid, "points.csv");
  EXPECT_DOUBLE_EQ(raster.at(0, 0), 1);
  EXPECT_TRUE(std::isnan(raster.at(9, 9)));
  const MapGrid one = test::grid_of(1, 1, 1, 0, 0);
  const ScatteredPoints twice{{0, 2, 0, 0}, {0, 0, 2, 0}, {1, 4, 4, 7}, ""};
  EXPECT_NEAR(interpolate_scattered(twice, one, "points.csv").at(0, 0), 4, 1e-12);
}

TEST(scattered, refuses_points_on_one_line) {
  const ScatteredPoints points{{0, 1, 2, 2}, {0, 1, 2, 2}, {1, 2, 3, 3}, ""};
  EXPECT_EQ(fault_of<DataError>([&] { interpolate_scattered(points, test::grid_of(2, 2, 1, 0, 0), "points.csv"); }),
            "points.csv: 4 points in 3 places (a surface needs three that do not lie on one line). Give more points, "
            "or a raster");
}

using point_table = test::InScratch;

TEST_F(point_table, reads_columns_by_name_in_any_order_and_blanks_semicolons_and_comments) {
  const auto file = scratch.write("p.csv", "id,Elevation,Easting,Northing\n1,100.5,10,20\n2,101,11,21\n");
  ASSERT_TRUE(is_point_file(file));
  const ScatteredPoints points = read_points(file);
  EXPECT_EQ(points.x, (std::vector<double>{10, 11}));
  EXPECT_EQ(points.y, (std::vector<double>{20, 21}));
  EXPECT_EQ(points.z, (std::vector<double>{100.5, 101}));
  const auto blanks = scratch.write("p.xyz", "# surveyed\n1 2\t3\n\n4;5;6  # last\r\n9.5 1e3 -2\n");
  ASSERT_TRUE(is_point_file(blanks));
  EXPECT_EQ(read_points(blanks).z, (std::vector<double>{3, 6, -2}));
}

TEST_F(point_table, knows_units_behind_the_names_of_columns) {
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

TEST_F(point_table, takes_no_depths_for_elevations_and_names_the_line_that_is_not_three_numbers) {
  EXPECT_TRUE(holds(data_fault([&] { read_points(scratch.write("p.csv", "x,y,depth\n1,2,3\n")); }), {"line 1"}));
  const ScatteredPoints both = read_points(scratch.write("q.csv", "x,y,z,depth\n1,2,3,4\n"));
  EXPECT_EQ(both.z, std::vector<double>{3});
  EXPECT_FALSE(both.are_depths);
  const auto file = scratch.write("l.csv", "x,y,z\n1,2,3\n1,two,3\n");
  EXPECT_EQ(data_fault([&] { read_points(file); }),
            "./l.csv: line 3: \"1,two,3\" (not three numbers x, y, z). Mend the line, or name the columns x,y,z in a "
            "first line");
}

TEST_F(point_table, with_thousands_that_a_sign_parts_is_refused_by_its_place) {
  const auto fault = [&](const std::string& text) {
    return data_fault([&] { read_points(scratch.write("p.csv", text)); });
  };
  const auto place = [&](const std::string& text, const std::string& at) {
    return holds(fault(text), {"./p.csv: " + at, "thousands"});
  };
  EXPECT_TRUE(place("430;200;1'234.5\n", "line 1, column 9: \"1'234.5\""));
  EXPECT_TRUE(place("430;200;1.234,5\n", "line 1, column 9: \"1.234,5\""));
  EXPECT_TRUE(place("430;200;1 234,5\n", "line 1, column 9: \"1 234,5\""));
  EXPECT_TRUE(place("430\t200\t1 234.5\n", "line 1, column 9: \"1 234.5\""));
  EXPECT_TRUE(place("430;200;8\n430;200;1,234\n", "line 2, column 9: \"1,234\""));
  EXPECT_TRUE(place("430;200;8,5\n430;200;1.234\n", "line 2, column 9: \"1.234\""));
  EXPECT_TRUE(place("430,200,1,234.5\n", "line 1, column 1: "));
  for (const char* plain :
       {"430123,456;200;1,234\n", "x,y,z,class\n100,200,300,255\n", "430,200,1234.5\n", "1 2 300\n"})
    EXPECT_EQ(fault(plain), "") << plain;
  EXPECT_TRUE(holds(fault(std::string("4\0,\0"
                                      "2\0,\0"
                                      "8\0",
                                      10)),
                    {"its text is UTF-16LE", "iconv -f UTF-16LE"}));
}

TEST_F(point_table, reads_decimal_commas_and_drops_no_rest_of_a_line) {
  EXPECT_EQ(read_points(scratch.write("p.csv", "x;y;z\n430,5;200;8,9\n")).z, std::vector<double>{8.9});
  EXPECT_EQ(read_points(scratch.write("q.txt", "430,5\t200\t8,9\n")).x, std::vector<double>{430.5});
  for (const char* text : {"x,y,z\n430,200,8,9\n", "430 200 8\n430 200 8 9\n"})
    EXPECT_TRUE(holds(data_fault([&] { read_points(scratch.write("r.csv", text)); }), {"line 2", "has 4 numbers"}));
  EXPECT_EQ(read_points(scratch.write("s.csv", "1.0,2.0,3.0,by hand\n4,5,6,bored\n")).z, (std::vector<double>{3, 6}));
  EXPECT_TRUE(holds(data_fault([&] { read_points(scratch.write("t.csv", "1;2;1.234,5\n")); }), {"line 1"}));
}

using point_file = test::InScratch;

TEST_F(point_file, reads_vector_points_with_elevation_and_refuses_those_in_degrees) {
  const auto file = scratch.write("p.geojson", test::geojson(test::feature("Point", "[500000,5100000,12.5]"), 32633));
  ASSERT_TRUE(is_point_file(file));
  const ScatteredPoints points = read_points(file);
  EXPECT_EQ(points.z, std::vector<double>{12.5});
  EXPECT_TRUE(same_crs(points.crs_wkt, metric_crs("EPSG:32633")));
  const auto degrees = scratch.write("d.geojson", test::geojson(test::feature("Point", "[13.5,47.1,12.5]")));
  EXPECT_EQ(data_fault([&] { read_points(degrees); }),
            "./d.geojson: CRS is EPSG:4326 (this stage needs metres). Reproject: ogr2ogr -t_srs EPSG:32633 d_utm.gpkg "
            "./d.geojson");
}

TEST_F(point_file, is_not_a_raster_or_an_ascii_grid_of_whatever_dialect) {
  const auto file =
      test::write(scratch, "dem.tif", test::raster_of(test::grid_of(3, 3, 1), [](double, double) { return 1.0; }));
  EXPECT_FALSE(is_point_file(file));
  const std::string grid = "ncols 2\nnrows 2\nxllcentre 10\nyllcentre 20\ncellsize 5\n1 2\n3 4\n";
  EXPECT_FALSE(is_point_file(scratch.write("dem.txt", grid)));
  EXPECT_FALSE(is_point_file(scratch.write("odd.txt", "# made by hand\n" + grid)));
  EXPECT_EQ(read_raster(scratch / "odd.txt").at(0, 0), 3);
}

TEST(metric_crs, refuses_degrees_and_unknown_names) {
  EXPECT_EQ(fault_of<RecipeError>([] { metric_crs("EPSG:4326"); }),
            "[preprocess]: working_crs = \"EPSG:4326\" (its coordinates are not in metres). Name a projected CRS in "
            "metres, such as the UTM zone of the place");
  EXPECT_EQ(
      fault_of<RecipeError>([] { metric_crs("EPSG:nought"); }),
      "[preprocess]: working_crs = \"EPSG:nought\" (no such CRS is known). Name it by its code, as in \"EPSG:32633\"");
}

/// Cells within `radius` of one are without value.
void punch(Raster& raster, int column, int row, double radius) {
  const int reach = static_cast<int>(radius);
  for (int r = row - reach; r <= row + reach; ++r)
    for (int c = column - reach; c <= column + reach; ++c)
      if (std::hypot(c - column, r - row) <= radius) raster.at(c, r) = std::nan("");
}

double largest_error(const Raster& a, const Raster& b) {
  double largest = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) largest = std::max(largest, std::abs(a.values[i] - b.values[i]));
  return largest;
}

TEST(voids, planes_and_quadratic_surfaces_are_reproduced) {
  const MapGrid grid = grid_of(60, 50, 5);
  const auto plane = [&](double x, double y) { return 900 + 0.8 * (x - grid.west) - 0.35 * (y - grid.south); };
  const auto quadratic = [&](double x, double y) {
    const double u = x - grid.west, v = y - grid.south;
    return plane(x, y) + 0.004 * u * u - 0.003 * u * v + 0.001 * v * v;
  };
  for (const Raster& surface : std::vector{raster_of(grid, plane), raster_of(grid, quadratic)}) {
    Raster holed = surface;
    punch(holed, 20, 25, 9.5);
    punch(holed, 40, 12, 0);
    punch(holed, 45, 35, 4.2);
    holed.at(20, 25) = surface.at(20, 25);  // an island in the void takes part
    const Filled filled = fill_voids(holed, 1e6);
    // Rounding alone: heights of 1000 m in doubles, summed over a hundred neighbours.
    EXPECT_LT(largest_error(filled.raster, surface), 1e-9);
    EXPECT_EQ(filled.voids.size(), 3u);
    EXPECT_LT(filled.rmse(), 1e-9);
  }
}

TEST(voids, what_was_filled_is_said_cell_by_cell_and_void_by_void) {
  const MapGrid grid = grid_of(40, 30, 10);
  std::mt19937 random(4);
  const Raster whole = raster_of(grid, test::Hills(grid, random));
  Raster holed = whole;
  punch(holed, 12, 14, 2);
  holed.at(30, 20) = std::nan("");
  const Filled filled = fill_voids(holed, 1e6);
  for (std::size_t i = 0; i < holed.values.size(); ++i) {
    EXPECT_EQ(filled.filled[i], std::isnan(holed.values[i]));
    EXPECT_EQ(filled.sigma[i] > 0, std::isnan(holed.values[i]));
    if (!std::isnan(holed.values[i])) {
      EXPECT_EQ(filled.raster.values[i], holed.values[i]);
    }
  }
  ASSERT_EQ(filled.voids.size(), 2u);
  EXPECT_EQ(filled.voids[0].cells, 13u);
  EXPECT_EQ(filled.voids[0].x, grid.x(12));
  EXPECT_EQ(filled.voids[0].y, grid.y(14));
  EXPECT_DOUBLE_EQ(filled.voids[0].largest_distance,
                   10 * std::sqrt(5));  // from the middle past a cell of the disc's corner
  EXPECT_EQ(filled.voids[0].trials, 8);
  EXPECT_EQ(filled.voids[1].cells, 1u);
  EXPECT_EQ(filled.count(), 14u);
}

TEST(voids, those_that_are_too_large_or_reach_the_edge_stay) {
  const MapGrid grid = grid_of(40, 30, 10);
  Raster holed = raster_of(grid, [](double, double) { return 100.0; });
  punch(holed, 12, 14, 3);  // 29 cells
  punch(holed, 25, 14, 1);  // 5 cells
  punch(holed, 2, 2, 2.5);  // at the corner
  const Filled filled = fill_voids(holed, 2800);
  EXPECT_EQ(filled.count(), 5u);
  EXPECT_TRUE(std::isnan(filled.raster.at(12, 14)));
  EXPECT_TRUE(std::isnan(filled.raster.at(2, 2)));
  EXPECT_EQ(filled.raster.at(25, 14), 100);
  ASSERT_EQ(filled.voids.size(), 2u);
  EXPECT_FALSE(filled.voids[0].filled && filled.voids[1].filled);
}

TEST(voids, no_place_to_measure_by_gives_no_error) {
  Raster holed = raster_of(grid_of(7, 7, 10), [](double x, double) { return 0.1 * x; });
  punch(holed, 3, 3, 1.5);
  const Filled filled = fill_voids(holed, 1e6);
  EXPECT_EQ(filled.count(), 9u);
  EXPECT_TRUE(std::isnan(filled.rmse()));
  EXPECT_TRUE(std::isnan(filled.sigma[filled.raster.grid.index(3, 3)]));
  EXPECT_TRUE(holds(summary(filled), {"no place beside them"}));
}

TEST(voids, the_stated_error_is_that_of_holes_in_real_terrain) {
  const auto file = test::survey_data("frank_slide/before_dem.tif");
  TALUS_NEED_DATA(file);
  const Raster whole = read_raster(file);
  std::mt19937 random(11);
  for (const double radius : {1.0, 3.0, 6.0}) {
    double true_squares = 0, stated_squares = 0, sibson_squares = 0, cells = 0;
    for (int trial = 0; trial < 25; ++trial) {
      const int column = 25 + static_cast<int>(random() % 150), row = 25 + static_cast<int>(random() % 150);
      Raster holed = whole;
      punch(holed, column, row, radius);
      const Filled filled = fill_voids(holed, 1e6);
      std::vector<Cell> hole;
      for (int r = 0; r < holed.grid.rows; ++r)
        for (int c = 0; c < holed.grid.columns; ++c)
          if (std::isnan(holed.at(c, r))) hole.push_back({c, r});
      const std::vector<double> plain = fill_hole(holed, hole, hole, HoleSurface::sibson);
      for (std::size_t i = 0; i < hole.size(); ++i) {
        const std::size_t cell = whole.grid.index(hole[i][0], hole[i][1]);
        true_squares += std::pow(filled.raster.values[cell] - whole.values[cell], 2);
        sibson_squares += std::pow(plain[i] - whole.values[cell], 2);
        stated_squares += std::pow(filled.sigma[cell], 2);
        ++cells;
      }
    }
    const double error = std::sqrt(true_squares / cells), stated = std::sqrt(stated_squares / cells);
    std::cerr << "holes of radius " << radius << ": error " << error << " m, stated " << stated
              << " m, without gradients " << std::sqrt(sibson_squares / cells) << " m\n";
    // The mean square over 25 holes of one mountain, estimated from the places around each: within a factor of two
    // (measured 1.1, 0.7, 1.6; one cliff in 25 holes makes as much).
    EXPECT_LT(stated, 2 * error);
    EXPECT_GT(stated, error / 2);
    // Gradients are worth it: half of the error goes (measured 0.50, 0.39, 0.45 of it left).
    EXPECT_LT(error, 0.75 * std::sqrt(sibson_squares / cells));
  }
}

TEST(voids, ten_thousand_cells_take_seconds) {
  const MapGrid grid = grid_of(340, 340, 5);
  std::mt19937 random(5);
  const Raster whole = raster_of(grid, test::Hills(grid, random));
  Raster holed = whole;
  test::punch(holed, {120, 120, 100, 100});
  const auto start = std::chrono::steady_clock::now();
  const Filled filled = fill_voids(holed, 1e6);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::cerr << "10,000 cells filled in " << seconds << " s: " << summary(filled) << "\n";
  EXPECT_EQ(filled.count(), 10000u);
  EXPECT_LT(seconds, 30);  // 3 s on one core of 2024; a laden machine may take longer
}

TEST(outliers, planted_spikes_and_pits_are_found_with_their_heights) {
  const MapGrid grid = grid_of(80, 60, 10);
  std::mt19937 random(6);
  Raster raster = raster_of(grid, test::Hills(grid, random));
  std::normal_distribution<double> noise(0, 0.15);
  for (double& z : raster.values) z += noise(random);
  raster.at(20, 20) += 40;
  raster.at(50, 33) -= 25;
  raster.at(51, 33) -= 30;  // beside one another
  raster.at(70, 5) += 6;
  const std::vector<Outlier> found = spikes_and_pits(raster);
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].cell, grid.index(20, 20));
  EXPECT_NEAR(found[0].height, 40, 1.5);  // the median of eight on a slope of 0.5 is off by a metre or so
  EXPECT_EQ(found[1].cell, grid.index(51, 33));
  EXPECT_NEAR(found[1].height, -30, 3);  // with a pit among its eight the median is the next height down
  EXPECT_EQ(found[3].cell, grid.index(70, 5));
  const std::string text = summary(found, grid);
  EXPECT_TRUE(test::begins(text, "2 spikes and 2 pits stand out from their neighbours: +"));
  EXPECT_TRUE(holds(text, {" m at x 500205.0, y 5100205.0; -"}));
}

TEST(outliers, smooth_ground_and_voids_raise_no_alarm) {
  const MapGrid grid = grid_of(80, 60, 10);
  std::mt19937 random(7);
  Raster raster = raster_of(grid, test::Hills(grid, random));
  punch(raster, 30, 30, 6);
  EXPECT_TRUE(spikes_and_pits(raster).empty());
  for (double& z : raster.values) z = std::floor(z);  // whole metres
  EXPECT_TRUE(spikes_and_pits(raster).empty());
}

TEST(outliers, real_terrain_raises_few_alarms) {
  for (const char* name : {"frank_slide/before_dem.tif", "cascade2021/before_dem.tif", "cascade2021/after_dem.tif"}) {
    const auto file = test::survey_data(name);
    TALUS_NEED_DATA(file);
    Raster raster = read_raster(file);
    const std::size_t alarms = spikes_and_pits(raster).size();
    std::cerr << name << ": " << alarms << " cells of " << raster.values.size()
              << " stand out: " << summary(spikes_and_pits(raster), raster.grid) << "\n";
    // Cliffs are real; one in five thousand is what a person can look at.
    EXPECT_LE(static_cast<double>(alarms), static_cast<double>(raster.values.size()) / 5000);
    std::mt19937 random(8);
    std::size_t planted = 0, found = 0;
    Raster spiked = raster;
    std::vector<std::size_t> cells;
    for (int i = 0; i < 20; ++i) {
      const int column = 1 + static_cast<int>(random() % static_cast<unsigned>(raster.grid.columns - 3)),
                row = 1 + static_cast<int>(random() % static_cast<unsigned>(raster.grid.rows - 2));
      const std::size_t cell = raster.grid.index(column, row);
      spiked.values[cell] += i % 2 == 0 ? 8 * raster.grid.cell : -8 * raster.grid.cell;
      cells.push_back(cell);
      ++planted;
    }
    for (const Outlier& outlier : spikes_and_pits(spiked))
      found += std::count(cells.begin(), cells.end(), outlier.cell) > 0;
    EXPECT_EQ(found, planted) << name;
  }
}

}  // namespace
}  // namespace talus::preprocess
