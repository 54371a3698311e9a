// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Different grids, CRS, extents and registrations brought to one grid.
#include "common/gis/crs.hpp"
#include "common/map/raster.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "preprocess/terrain/working_grid.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

using align = test::WithScene;

TEST_F(align, takes_the_common_part_of_two_extents) {
  rewrite_after(cut(after, {4, 3, 30, 25}));
  const Domain domain = prepare().domain;
  EXPECT_EQ(domain.grid.columns, 30);
  EXPECT_EQ(domain.grid.rows, 25);
  EXPECT_DOUBLE_EQ(domain.grid.west, grid.west + 40);
  EXPECT_DOUBLE_EQ(domain.grid.south, grid.south + 30);
  EXPECT_EQ(domain.before.at(0, 0), before.at(4, 3));
}

TEST_F(align, keeps_the_corner_of_the_first_model_at_another_spacing) {
  options.grid.spacing = 15;
  const Domain domain = prepare().domain;
  EXPECT_EQ(domain.grid.columns, 26);  // 400 m hold 26 whole cells of 15 m
  EXPECT_EQ(domain.grid.rows, 20);
  EXPECT_DOUBLE_EQ(domain.grid.west, grid.west);
  EXPECT_DOUBLE_EQ(domain.grid.south, grid.south);
  EXPECT_EQ(domain.layer_height, default_layer_height(domain.release_thickness, 15)) << "the recipe names none";
}

/// A plane stays a plane on any other grid, except where a border cell has no neighbour to weigh with.
void expect_plane_kept(double cell) {
  Scene scene;
  const auto plane = [&](double x, double y) {
    return 500 + 0.4 * (x - scene.grid.west) - 0.2 * (y - scene.grid.south);
  };
  scene.rewrite_before(test::raster_of(scene.grid, plane));
  const int columns = static_cast<int>(440 / cell), rows = static_cast<int>(340 / cell);
  const MapGrid shifted = test::grid_of(columns, rows, cell, scene.grid.west - 13, scene.grid.south - 17);
  scene.rewrite_after(test::raster_of(shifted, [&](double x, double y) { return plane(x, y) - 5; }));
  const Prepared prepared = scene.prepare();
  const MapGrid& grid = prepared.domain.grid;
  for (int row = 2; row < grid.rows - 2; ++row)
    for (int column = 2; column < grid.columns - 2; ++column)
      ASSERT_NEAR(prepared.domain.release_thickness.at(column, row), 5, 1e-9) << "cells of " << cell;
}

TEST_F(align, resamples_a_model_registered_otherwise) { expect_plane_kept(10); }
TEST_F(align, resamples_a_coarser_model) { expect_plane_kept(13); }
TEST_F(align, resamples_a_finer_model) {
  for (const double cell : {9.0, 7.0, 5.0, 2.3}) expect_plane_kept(cell);
}

TEST_F(align, does_not_average_over_a_void) {
  MapGrid fine = test::grid_of(160, 120, 2.5);
  Raster after = test::raster_of(fine, [](double, double) { return 0.0; });
  after.at(101, 41) = std::nan("");
  rewrite_after(after);
  EXPECT_TRUE(
      test::begins(data_fault(), "./after.tif: 1 cell without elevation, at x 500255.0, y 5100105.0 (nodata or NaN"));
}

TEST_F(align, crops_to_whole_cells_inside_the_given_edges) {
  options.grid.extent = {this->grid.west + 55, this->grid.south, this->grid.east(), this->grid.south + 248};
  const MapGrid grid = prepare().domain.grid;
  EXPECT_DOUBLE_EQ(grid.west, this->grid.west + 60);
  EXPECT_DOUBLE_EQ(grid.north(), this->grid.south + 240);
  EXPECT_DOUBLE_EQ(grid.east(), this->grid.east());
}

TEST_F(align, brings_a_model_from_another_crs) {
  before.grid.crs_wkt = metric_crs("EPSG:32633");
  // The same ground seen from the neighbouring zone: drawn there on a larger grid, of a smooth surface.
  MapGrid there = test::grid_of(0, 0, 5);
  there.crs_wkt = metric_crs("EPSG:32632");
  const Extent extent = transform_extent({before.grid.west, before.grid.south, before.grid.east(), before.grid.north()},
                                         before.grid.crs_wkt, there.crs_wkt);
  there.west = std::floor(extent.west) - 20;
  there.south = std::floor(extent.south) - 20;
  there.columns = static_cast<int>((extent.east - there.west) / 5) + 5;
  there.rows = static_cast<int>((extent.north - there.south) / 5) + 5;
  rewrite_before(test::raster_of(before.grid, [](double, double) { return 100.0; }));
  const Extent source = transform_extent({before.grid.x(10), before.grid.y(10), before.grid.x(20), before.grid.y(20)},
                                         before.grid.crs_wkt, there.crs_wkt);
  const double x0 = (source.west + source.east) / 2, y0 = (source.south + source.north) / 2;
  rewrite_after(test::raster_of(there, [&](double x, double y) {
    return 100 - 10 * std::exp(-(std::pow(x - x0, 2) + std::pow(y - y0, 2)) / 1600);
  }));
  options.source.threshold = 0.01;
  const Prepared prepared = prepare();
  EXPECT_TRUE(same_crs(prepared.domain.grid.crs_wkt, before.grid.crs_wkt));
  EXPECT_EQ(prepared.domain.grid.columns, 40);
  // Both zones stretch lengths: 0.9996 on the middle of zone 33, where the scene lies, 1.0014 three degrees of zone 32
  // off.
  EXPECT_NEAR(prepared.total.volume / (M_PI * 1600 * 10), 1, 0.01);
  const auto deepest = std::max_element(prepared.domain.release_thickness.values.begin(),
                                        prepared.domain.release_thickness.values.end());
  const auto cell = static_cast<int>(deepest - prepared.domain.release_thickness.values.begin());
  const int column = cell % 40, row = cell / 40;
  EXPECT_NEAR(column, 15, 1);
  EXPECT_NEAR(row, 15, 1);
}

TEST_F(align, works_in_another_crs_than_the_models) {
  before.grid.crs_wkt = after.grid.crs_wkt = metric_crs("EPSG:32633");
  rewrite_before(before);
  rewrite_after(after);
  const double volume = prepare().total.volume;
  options.working_crs = "EPSG:32632";
  options.source.threshold = 0.05;  // bilinear rounding lowers a little everywhere
  options.grid.spacing = 5;
  const Prepared prepared = prepare();
  EXPECT_TRUE(same_crs(prepared.domain.grid.crs_wkt, metric_crs("EPSG:32632")));
  EXPECT_NEAR(prepared.total.volume / volume, 1, 0.02);  // areas differ by 0.4 %, the rest is bilinear
  for (double z : prepared.domain.terrain.values) ASSERT_FALSE(std::isnan(z));
}

TEST_F(align, triangulates_a_model_of_points) {
  test::Seeded random;
  std::string text = "x,y,z\n";
  const auto plane = [&](double x, double y) { return 500 + 0.4 * (x - grid.west) - 0.2 * (y - grid.south); };
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 500; ++i) {
    const double x = grid.west + 400 * part(random), y = grid.south + 300 * part(random);
    text += fmt::format("{},{},{}\n", x, y, plane(x, y));
  }
  options.before_dem = scratch.write("before.csv", text);
  rewrite_after(test::raster_of(grid, [&](double x, double y) { return plane(x, y) - 2; }));
  options.grid.spacing = 8;
  const Prepared prepared = prepare();
  EXPECT_GT(prepared.domain.grid.count(), 900u);  // of 50 x 37: the border is ragged
  for (double t : prepared.domain.before.values) ASSERT_FALSE(std::isnan(t));
  EXPECT_NEAR(prepared.domain.before.at(3, 4), plane(prepared.domain.grid.x(3), prepared.domain.grid.y(4)), 1e-8);
}

TEST_F(align, asks_for_the_spacing_of_points) {
  options.before_dem = scratch.write("before.csv", "500000,5100000,1\n500400,5100000,1\n500000,5100300,1\n");
  EXPECT_EQ(recipe_fault(),
            "[preprocess.grid]: spacing_m is not given (./before.csv holds points, which have no cell size). Give "
            "spacing_m, about the distance between the points");
}

TEST_F(align, leaves_out_border_lines_without_any_data) {
  for (int row = 0; row < 30; ++row) after.at(39, row) = after.at(38, row) = std::nan("");
  rewrite_after(after);
  EXPECT_EQ(prepare().domain.grid.columns, 38);
}

TEST_F(align, leaves_edge_nodata_outside_the_domain_when_asked) {
  for (int row = 0; row < 6; ++row) after.at(39 - row, 29) = after.at(39, 29 - row) = std::nan("");
  rewrite_after(after);
  options.grid.edge_nodata = EdgeNodata::outside;
  const Domain domain = prepare().domain;
  EXPECT_TRUE(std::isnan(domain.terrain.at(39, 29)));
  EXPECT_TRUE(std::isnan(domain.before.at(39, 29)));
  EXPECT_EQ(domain.release_thickness.at(39, 29), 0);
  EXPECT_FALSE(std::isnan(domain.terrain.at(30, 20)));
}

TEST(trimmed, leaves_a_rectangle_without_holes_on_its_border) {
  const MapGrid grid = test::grid_of(50, 40, 1, 0, 0);
  std::vector<char> empty(grid.count());
  for (int row = 0; row < 40; ++row)
    for (int column = 0; column < 50; ++column) {  // data inside a turned square
      const double u = column - 25 + 0.1 * (row - 20), v = row - 20 - 0.1 * (column - 25);
      empty[grid.index(column, row)] = std::abs(u) > 22 || std::abs(v) > 17;
    }
  const CellWindow w = trimmed(grid, empty, 0);
  EXPECT_GT(w.columns * w.rows, 0.8 * 44 * 34);
  for (int row = w.row; row < w.row + w.rows; ++row)
    for (int column = w.column; column < w.column + w.columns; ++column) ASSERT_FALSE(empty[grid.index(column, row)]);
}

/// A slope near 13.5 E, 47.1 N, on cells of about 10 m, in degrees: before, and after with a bowl taken out.
struct geographic : test::InScratch {
  Options options;
  static constexpr double west = 13.5, south = 47.1, cell = 0.0001, radius = 200, depth = 20;
  const std::string utm = metric_crs("EPSG:32633");

  geographic() {
    write_models(1);
    options.before_dem = scratch / "before.tif";
    options.after_dem = scratch / "after.tif";
    options.grid.layer_height = 5;
    options.accept = {"doubtful-source"};  // there is no deposit
  }
  void write_models(double metres) const {
    write("before.tif", 0, metres);
    write("after.tif", depth, metres);
  }
  double volume() const { return 0.5 * M_PI * radius * radius * depth; }  // of a paraboloid

  /// Heights at places in degrees, with a paraboloid of `bowl` metres cut out of a slope at the middle.
  std::vector<double> heights(std::vector<double> x, std::vector<double> y, double bowl) const {
    x.push_back(west + 75 * cell);
    y.push_back(south + 50 * cell);
    transform_places(crs_by_name("EPSG:4326"), utm, x, y);
    std::vector<double> z;
    for (std::size_t i = 0; i + 1 < x.size(); ++i) {
      const double dx = x[i] - x.back(), dy = y[i] - y.back();
      z.push_back(1500 + 0.3 * dx - 0.1 * dy - bowl * std::max(0.0, 1 - (dx * dx + dy * dy) / (radius * radius)));
    }
    return z;
  }
  void write(const char* name, double bowl, double metres) const {
    Raster raster{{150, 100, west, south, cell, crs_by_name("EPSG:4326")}, {}};
    std::vector<double> x, y;
    for (int r = 0; r < 100; ++r)
      for (int c = 0; c < 150; ++c) x.push_back(raster.grid.x(c)), y.push_back(raster.grid.y(r));
    raster.values = heights(x, y, bowl);
    for (double& z : raster.values) z /= metres;
    write_geotiff(scratch / name, raster, {});
  }
};

TEST_F(geographic, a_pair_in_degrees_is_refused_with_two_ways_out_and_one_without_crs_has_no_utm_zone) {
  EXPECT_EQ(data_fault([&] { prepare(options, Points::counted); }),
            "./before.tif: CRS is EPSG:4326, in degrees (this stage needs metres). Reproject: gdalwarp -t_srs "
            "EPSG:32633 -r bilinear ./before.tif before_utm.tif; or set working_crs = \"utm\" in [preprocess]");
  test::write(scratch, "local.tif", test::raster_of(test::grid_of(5, 5, 10), [](double, double) { return 1.0; }));
  options.before_dem = scratch / "local.tif";
  options.working_crs = "utm";
  EXPECT_TRUE(test::begins(data_fault([&] { prepare(options, Points::counted); }),
                           "./local.tif: has no CRS (so its UTM zone cannot be told). Give it one: "));
}

TEST_F(geographic, a_pair_in_degrees_keeps_its_volume_in_its_utm_zone_and_one_that_is_named) {
  options.working_crs = "utm";
  const Prepared prepared = prepare(options, Points::counted);
  EXPECT_EQ(crs_name(prepared.domain.grid.crs_wkt), "EPSG:32633");
  EXPECT_NEAR(prepared.domain.grid.cell, 9.2, 0.06);  // of 7.6 x 11.1 m
  // Cells of 9 m on a bowl of 200 m: the rim below the threshold of half a metre holds (0.5 / 20)^2 of the volume, the
  // scale of UTM 1 in a thousand of the area.
  EXPECT_NEAR(prepared.total.volume / volume(), 1, 0.003);
  options.working_crs = "EPSG:32632";
  const Prepared beside = prepare(options, Points::counted);
  EXPECT_EQ(crs_name(beside.domain.grid.crs_wkt), "EPSG:32632");
  // Zone 32 is 4.5 degrees away: its scale is 0.9996 + 0.5 (4.5 deg cos 47 deg)^2 = 1.0010, squared for the area.
  EXPECT_NEAR(beside.total.volume / volume(), std::pow(1.0010 / 0.99980, 2), 0.003);
}

TEST_F(geographic, points_in_degrees_are_moved_to_the_utm_zone) {
  test::Seeded random;
  std::uniform_real_distribution<double> part(0, 1);
  std::vector<double> x, y;
  for (int i = 0; i < 15000; ++i) {
    x.push_back(west + 150 * cell * part(random));
    y.push_back(south + 100 * cell * part(random));
  }
  const std::vector<double> z = heights(x, y, depth);
  std::string table = "longitude,latitude,height\n";
  for (std::size_t i = 0; i < x.size(); ++i) table += fmt::format("{:.8f},{:.8f},{:.4f}\n", x[i], y[i], z[i]);
  options.after_dem = scratch.write("after.csv", table);
  options.working_crs = "utm";
  const Prepared prepared = prepare(options, Points::counted);
  EXPECT_EQ(crs_name(prepared.domain.grid.crs_wkt), "EPSG:32633");
  // Linear in triangles of 10 m: a paraboloid of curvature 2 depth / radius^2 = 1e-3 / m is off by up to 1e-2 m.
  EXPECT_NEAR(prepared.total.volume / volume(), 1, 0.005);
}

TEST_F(geographic, heights_in_feet_that_the_files_do_not_declare_are_named_in_the_recipe) {
  write_models(0.3048);
  options.working_crs = "utm";
  options.vertical_unit = VerticalUnit::foot;
  EXPECT_NEAR(prepare(options, Points::counted).total.volume / volume(), 1, 0.003);
}

}  // namespace
}  // namespace talus::preprocess
