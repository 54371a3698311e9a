// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Different grids, CRS, extents and registrations brought to one grid.
#include "common/gis/coordinates.hpp"
#include "common/gis/crs.hpp"
#include "common/map/crop.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/terrain/geo_input.hpp"
#include "preprocess/terrain/working_grid.hpp"
#include "tests/preprocess/scene.hpp"

namespace talus::preprocess {
namespace {

using test::Scene;

TEST(align, takes_the_common_part_of_two_extents) {
  Scene scene;
  scene.rewrite_after(cut(scene.after, {4, 3, 30, 25}));
  const Domain domain = scene.prepare().domain;
  EXPECT_EQ(domain.grid.columns, 30);
  EXPECT_EQ(domain.grid.rows, 25);
  EXPECT_DOUBLE_EQ(domain.grid.west, scene.grid.west + 40);
  EXPECT_DOUBLE_EQ(domain.grid.south, scene.grid.south + 30);
  EXPECT_EQ(domain.before.at(0, 0), scene.before.at(4, 3));
}

TEST(align, keeps_the_corner_of_the_first_model_at_another_spacing) {
  Scene scene;
  scene.options.grid.spacing = 15;
  const Domain domain = scene.prepare().domain;
  EXPECT_EQ(domain.grid.columns, 26);  // 400 m hold 26 whole cells of 15 m
  EXPECT_EQ(domain.grid.rows, 20);
  EXPECT_DOUBLE_EQ(domain.grid.west, scene.grid.west);
  EXPECT_DOUBLE_EQ(domain.grid.south, scene.grid.south);
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

TEST(align, resamples_a_model_registered_otherwise) { expect_plane_kept(10); }
TEST(align, resamples_a_coarser_model) { expect_plane_kept(13); }
TEST(align, resamples_a_finer_model) {
  for (const double cell : {9.0, 7.0, 5.0, 2.3}) expect_plane_kept(cell);
}

TEST(align, does_not_average_over_a_void) {
  Scene scene;
  MapGrid fine = test::grid_of(160, 120, 2.5);
  Raster after = test::raster_of(fine, [](double, double) { return 0.0; });
  after.at(101, 41) = std::nan("");
  scene.rewrite_after(after);
  EXPECT_EQ(scene.data_fault().find(scene.path("after.tif") +
                                    ": 1 cell without elevation, at x 500255.0, y 5100105.0 (nodata or NaN"),
            0u);
}

TEST(align, crops_to_whole_cells_inside_the_given_edges) {
  Scene scene;
  scene.options.grid.extent = {scene.grid.west + 55, scene.grid.south, scene.grid.east(), scene.grid.south + 248};
  const MapGrid grid = scene.prepare().domain.grid;
  EXPECT_DOUBLE_EQ(grid.west, scene.grid.west + 60);
  EXPECT_DOUBLE_EQ(grid.north(), scene.grid.south + 240);
  EXPECT_DOUBLE_EQ(grid.east(), scene.grid.east());
}

TEST(align, brings_a_model_from_another_crs) {
  Scene scene;
  Raster before = scene.before, after = scene.after;
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
  scene.rewrite_before(test::raster_of(before.grid, [](double, double) { return 100.0; }));
  const Extent source = transform_extent({before.grid.x(10), before.grid.y(10), before.grid.x(20), before.grid.y(20)},
                                         before.grid.crs_wkt, there.crs_wkt);
  const double x0 = (source.west + source.east) / 2, y0 = (source.south + source.north) / 2;
  scene.rewrite_after(test::raster_of(there, [&](double x, double y) {
    return 100 - 10 * std::exp(-(std::pow(x - x0, 2) + std::pow(y - y0, 2)) / 1600);
  }));
  scene.options.source.threshold = 0.01;
  const Prepared prepared = scene.prepare();
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

TEST(align, works_in_another_crs_than_the_models) {
  Scene scene;
  Raster before = scene.before, after = scene.after;
  before.grid.crs_wkt = after.grid.crs_wkt = metric_crs("EPSG:32633");
  scene.rewrite_before(before);
  scene.rewrite_after(after);
  const double volume = scene.prepare().total.volume;
  scene.options.working_crs = "EPSG:32632";
  scene.options.source.threshold = 0.05;  // bilinear rounding lowers a little everywhere
  scene.options.grid.spacing = 5;
  const Prepared prepared = scene.prepare();
  EXPECT_TRUE(same_crs(prepared.domain.grid.crs_wkt, metric_crs("EPSG:32632")));
  EXPECT_NEAR(prepared.total.volume / volume, 1, 0.02);  // areas differ by 0.4 %, the rest is bilinear
  for (double z : prepared.domain.terrain.values) ASSERT_FALSE(std::isnan(z));
}

TEST(align, triangulates_a_model_of_points) {
  TALUS_SEEDED(seed);
  Scene scene(seed);
  std::string text = "x,y,z\n";
  const auto plane = [&](double x, double y) {
    return 500 + 0.4 * (x - scene.grid.west) - 0.2 * (y - scene.grid.south);
  };
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(0, 1);
  for (int i = 0; i < 500; ++i) {
    const double x = scene.grid.west + 400 * part(random), y = scene.grid.south + 300 * part(random);
    text += fmt::format("{},{},{}\n", x, y, plane(x, y));
  }
  scene.options.before_dem = scene.scratch.write("before.csv", text);
  scene.rewrite_after(test::raster_of(scene.grid, [&](double x, double y) { return plane(x, y) - 2; }));
  scene.options.grid.spacing = 8;
  const Prepared prepared = scene.prepare();
  EXPECT_GT(prepared.domain.grid.count(), 900u);  // of 50 x 37: the border is ragged
  for (double t : prepared.domain.before.values) ASSERT_FALSE(std::isnan(t));
  EXPECT_NEAR(prepared.domain.before.at(3, 4), plane(prepared.domain.grid.x(3), prepared.domain.grid.y(4)), 1e-8);
}

TEST(align, asks_for_the_spacing_of_points) {
  Scene scene;
  scene.options.before_dem =
      scene.scratch.write("before.csv", "500000,5100000,1\n500400,5100000,1\n500000,5100300,1\n");
  EXPECT_EQ(scene.recipe_fault(),
            "[preprocess.grid]: spacing_m is not given (" + scene.path("before.csv") +
                " holds points, which have no cell size). Give spacing_m, about the distance between the points");
}

TEST(align, leaves_out_border_lines_without_any_data) {
  Scene scene;
  Raster after = scene.after;
  for (int row = 0; row < 30; ++row) after.at(39, row) = after.at(38, row) = std::nan("");
  scene.rewrite_after(after);
  EXPECT_EQ(scene.prepare().domain.grid.columns, 38);
}

TEST(align, leaves_edge_nodata_outside_the_domain_when_asked) {
  Scene scene;
  Raster after = scene.after;
  for (int row = 0; row < 6; ++row) after.at(39 - row, 29) = after.at(39, 29 - row) = std::nan("");
  scene.rewrite_after(after);
  scene.options.grid.edge_nodata = EdgeNodata::outside;
  const Domain domain = scene.prepare().domain;
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

}  // namespace
}  // namespace talus::preprocess
