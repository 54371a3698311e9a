// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>

#include "common/map/polygon.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/regions/way_down.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

using test::fault_of;
using test::holds;

/// The cells of the way from one on.
std::vector<std::size_t> way_from(const Raster& surface, std::size_t cell) {
  WayDown way(surface);
  std::vector<std::size_t> cells;
  for (std::vector<std::size_t> next = way.next(cell); !next.empty(); next = way.next(cells.back()))
    cells.insert(cells.end(), next.begin(), next.end());
  return cells;
}

TEST(way_down, of_a_plane_is_its_line_of_fall_and_enters_no_cells_without_elevation) {
  const MapGrid grid = test::grid_of(9, 20, 10);
  const auto cells = way_from(test::raster_of(grid, [](double, double y) { return 0.3 * y; }), grid.index(4, 15));
  ASSERT_EQ(cells.size(), 15u);
  for (std::size_t i = 0; i < cells.size(); ++i) EXPECT_EQ(cells[i], grid.index(4, 14 - static_cast<int>(i)));
  Raster surface = test::raster_of(grid, [](double, double y) { return 0.3 * y; });
  for (int column = 0; column < 9; ++column) surface.at(column, 8) = nan;
  for (const std::size_t c : way_from(surface, grid.index(4, 15))) EXPECT_GE(c, grid.index(0, 9));
}

TEST(way_down, leaves_a_hollow_over_its_lowest_rim) {
  const MapGrid grid = test::grid_of(9, 20, 10);
  Raster surface = test::raster_of(grid, [&](double, double y) { return 0.3 * (y - grid.south); });
  for (int row = 0; row < 20; ++row) surface.at(0, row) = surface.at(8, row) = 100;  // the sides of a valley
  for (int column = 1; column < 8; ++column) surface.at(column, 8) += 20;            // a dam
  surface.at(7, 8) -= 10;                                                            // and the notch in it
  const auto cells = way_from(surface, grid.index(2, 15));
  EXPECT_NE(std::find(cells.begin(), cells.end(), grid.index(7, 8)), cells.end());
  EXPECT_LT(cells.back(), grid.index(0, 1)) << "it reaches the edge of the map";
}

TEST(way_down, ends_everywhere_on_rough_and_level_ground) {
  test::Seeded random;
  std::uniform_int_distribution<int> height(0, 3);  // many hollows and many level places
  const MapGrid grid = test::grid_of(40, 40, 10);
  const Raster surface = test::raster_of(grid, [&](double, double) { return static_cast<double>(height(random)); });
  for (std::size_t c = 0; c < grid.count(); c += 7) EXPECT_LT(way_from(surface, c).size(), 4 * grid.count());
}

using Ring = std::vector<std::array<double, 2>>;

MapPolygon polygon_of(std::vector<Ring> rings) {
  MapPolygon polygon;
  polygon.rings = std::move(rings);
  return polygon;
}

/// A star around (x, y): radii alternate at random, so it is simple but far from convex.
Ring star(double x, double y, double radius, int corners, std::mt19937& random) {
  std::uniform_real_distribution<double> part(0.35, 1.0);
  Ring ring;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners, r = radius * part(random);
    ring.push_back({x + r * std::cos(angle), y + r * std::sin(angle)});
  }
  return ring;
}

/// Reference: each ring cut to one cell (Sutherland and Hodgman 1974), whose signed area needs no care for bridges.
double ring_area_in_cell(Ring ring, double west, double south, double cell) {
  const double bounds[] = {west, west + cell, south, south + cell};
  for (std::size_t side = 0; side < 4; ++side) {
    const std::size_t axis = side / 2;
    const double bound = bounds[side], sign = side % 2 == 0 ? 1 : -1;
    Ring kept;
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
      const double da = sign * (a[axis] - bound), db = sign * (b[axis] - bound);
      if (da >= 0) kept.push_back(a);
      if ((da >= 0) != (db >= 0)) {
        const double t = da / (da - db);
        kept.push_back({a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])});
      }
    }
    ring = std::move(kept);
  }
  double twice = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
    twice += (a[0] - west) * (b[1] - south) - (b[0] - west) * (a[1] - south);
  }
  return std::abs(twice / 2);
}

TEST(polygon_cover, equals_each_cell_clipped_for_itself) {
  test::Seeded random;
  const MapGrid grid = test::grid_of(31, 27, 7.5);
  const double x = grid.west + 110, y = grid.south + 97;
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<MapPolygon> polygons{polygon_of({star(x, y, 90, 41, random), star(x, y, 25, 9, random)})};
    check_polygons(polygons, "test");
    const auto covered = coverage(grid, polygons[0], "test");
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const double west = grid.west + column * grid.cell, south = grid.south + row * grid.cell;
        const double area = ring_area_in_cell(polygons[0].rings[0], west, south, grid.cell) -
                            ring_area_in_cell(polygons[0].rings[1], west, south, grid.cell);
        ASSERT_NEAR(covered[grid.index(column, row)], area / (grid.cell * grid.cell), 1e-9) << column << " " << row;
      }
    }
  }
}

TEST(polygon_cover, sums_to_the_area_of_the_polygon) {
  test::Seeded random;
  for (const double cell : {0.7, 3.0, 10.0, 37.0}) {
    const MapGrid grid =
        test::grid_of(static_cast<int>(300 / cell) + 1, static_cast<int>(300 / cell) + 1, cell, 412345.6, 5012345.6);
    std::vector<MapPolygon> polygons{polygon_of({star(grid.west + 150, grid.south + 150, 140, 67, random),
                                                 star(grid.west + 150, grid.south + 150, 40, 13, random)})};
    check_polygons(polygons, "test");
    Raster cover{grid, coverage(grid, polygons[0], "test")};
    EXPECT_NEAR(test::volume_of(cover) / area_of(polygons[0]), 1, 1e-12) << "cells of " << cell;
  }
}

TEST(polygon_cover, is_exact_for_outlines_along_cell_borders) {
  const MapGrid grid = test::grid_of(10, 10, 10, 0, 0);
  std::vector<MapPolygon> polygons{polygon_of({{{20, 30}, {60, 30}, {60, 70}, {20, 70}}})};
  check_polygons(polygons, "test");
  const auto covered = coverage(grid, polygons[0], "test");
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 10; ++column)
      EXPECT_EQ(covered[grid.index(column, row)], column >= 2 && column < 6 && row >= 3 && row < 7 ? 1.0 : 0.0);
}

TEST(polygon_cover, does_not_depend_on_the_sense_of_the_rings) {
  const MapGrid grid = test::grid_of(10, 10, 10, 0, 0);
  const Ring outer{{5, 5}, {95, 12}, {70, 88}}, hole{{50, 30}, {60, 35}, {55, 45}};
  std::vector<MapPolygon> one{polygon_of({outer, hole})},
      other{polygon_of({{outer.rbegin(), outer.rend()}, {hole.rbegin(), hole.rend()}})};
  check_polygons(one, "test");
  check_polygons(other, "test");
  EXPECT_GT(area_of(one[0]), 0);
  EXPECT_NEAR(area_of(one[0]), area_of(other[0]), 1e-9);
  const auto a = coverage(grid, one[0], "test"), b = coverage(grid, other[0], "test");
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-14);
}

std::string refusal(std::vector<Ring> rings) {
  std::vector<MapPolygon> polygons{polygon_of(std::move(rings))};
  return fault_of<DataError>([&] { check_polygons(polygons, "outline.shp"); });
}

TEST(polygon_check, names_the_place_where_an_outline_is_not_valid) {
  const Ring square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const std::tuple<const char*, std::vector<Ring>, const char*> outlines[] = {
      {"it crosses itself", {{{0, 0}, {10, 10}, {10, 0}, {0, 10}}}, "Self-intersection at or near point 5 5"},
      {"a corner lies on another edge",
       {{{0, 0}, {10, 0}, {10, 10}, {5, 0}, {0, 10}}},
       "Ring Self-intersection at or near point 5 0"},
      {"a hole lies outside",
       {square, {{20, 20}, {25, 20}, {20, 25}}},
       "Hole lies outside shell at or near point 20 20"}};
  for (const auto& [what, rings, why] : outlines)
    EXPECT_EQ(refusal(rings), std::string("outline.shp: polygon 1 is not valid (") + why +
                                  "). Mend it in a GIS, or: ogr2ogr -makevalid out.gpkg outline.shp")
        << what;
}

TEST(polygon_check, refuses_outlines_that_are_none_by_name_and_allows_repeated_corners_and_a_hole_that_touches) {
  const Ring square{{0, 0}, {10, 0}, {10, 10}, {0, 10}};
  const std::tuple<const char*, std::vector<Ring>, const char*> outlines[] = {
      {"a spike", {{{0, 0}, {10, 0}, {10, 10}, {10, 4}, {10, 20}, {0, 20}}}, "Self-intersection"},
      {"a hole across the outline", {square, {{8, 5}, {12, 4}, {12, 6}}}, "Self-intersection"},
      {"a hole within a hole", {square, {{2, 2}, {8, 2}, {8, 8}, {2, 8}}, {{4, 4}, {6, 4}, {5, 6}}}, "nested"},
      {"a hole that cuts the outline in two", {square, {{0, 5}, {5, 4}, {10, 5}, {5, 6}}}, "disconnected"},
      {"two corners", {{{0, 0}, {10, 10}}}, "Too few points"},
      {"no area", {{{0, 0}, {10, 10}, {20, 20}}}, "is not valid"},
      {"nothing", {}, "it has no corners"},
      {"one corner", {{{0, 0}}}, "is not valid"}};
  for (const auto& [what, rings, why] : outlines) EXPECT_TRUE(test::holds(refusal(rings), {why})) << what;
  std::vector<MapPolygon> polygons{polygon_of({{{0, 0}, {10, 0}, {10, 10}}}), polygon_of({{{0, 0}, {10, 10}}})};
  polygons[1].name = "scar";
  const std::string fault = fault_of<DataError>([&] { check_polygons(polygons, "outline.shp"); });
  EXPECT_TRUE(test::begins(fault, "outline.shp: polygon 2 \"scar\" is not valid ("));
  EXPECT_EQ(refusal({{{0, 0}, {10, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}}), "");
  EXPECT_EQ(refusal({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{10, 5}, {5, 4}, {5, 6}}}), "");
}

TEST(polygon_cover, refuses_a_polygon_beyond_the_grid) {
  std::vector<MapPolygon> polygons{polygon_of({{{0, 0}, {10, 0}, {10, 10}, {0, 10}}})};
  polygons[0].name = "A";
  const auto text = fault_of<DataError>([&] { coverage(test::grid_of(5, 5, 1, 6, 0), polygons[0], "outline.shp"); });
  EXPECT_EQ(text,
            "outline.shp: polygon \"A\" reaches x 0.0, y 0.0, outside the working grid (x 6.0..11.0, y 0.0..5.0) (it "
            "must lie on the DEM). Check the CRS of both, give a DEM that reaches further, or clip the polygon");
}

TEST(polygon_cover, counts_what_of_a_polygon_lies_on_the_grid) {
  test::Seeded random;
  const MapGrid grid = test::grid_of(21, 17, 7.5);
  for (const auto& [dx, dy] : {std::pair{0.0, 0.0}, {80.0, 40.0}, {-3000.0, 60.0}}) {
    MapPolygon polygon = polygon_of({star(grid.west + dx, grid.south + dy, 120, 40, random)});
    polygon.rings.push_back(star(grid.west + dx, grid.south + dy, 35, 12, random));
    std::reverse(polygon.rings[1].begin(), polygon.rings[1].end());
    const std::vector<double> covered = coverage_within(grid, polygon);
    for (int row = 0; row < grid.rows; ++row) {
      for (int column = 0; column < grid.columns; ++column) {
        const double west = grid.west + column * grid.cell, south = grid.south + row * grid.cell;
        const double area = ring_area_in_cell(polygon.rings[0], west, south, grid.cell) -
                            ring_area_in_cell(polygon.rings[1], west, south, grid.cell);
        ASSERT_NEAR(covered[grid.index(column, row)] * grid.cell * grid.cell, area, 1e-7)
            << "cell " << column << ", " << row;
      }
    }
  }
}

}  // namespace
}  // namespace talus::preprocess
