// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells a polygon holds.
#include "common/map/cells_inside.hpp"
#include "common/map/polygon.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace talus {
namespace {

MapGrid square_grid(int cells) {
  return {.columns = cells, .rows = cells, .west = 100, .south = 200, .cell = 1, .crs_wkt = ""};
}

TEST(cells_inside, counts_cells_whose_centre_lies_in_a_ring_and_not_in_its_hole) {
  const MapPolygon square{
      {{{101, 201}, {105, 201}, {105, 205}, {101, 205}}, {{102, 202}, {102, 204}, {104, 204}, {104, 202}}}, {}, ""};
  const auto inside = cells_inside({square}, square_grid(8));
  EXPECT_EQ(std::count(inside.begin(), inside.end(), 1), 16 - 4);
  EXPECT_EQ(inside[square_grid(8).index(1, 1)], 1);
  EXPECT_EQ(inside[square_grid(8).index(2, 2)], 0);
  EXPECT_EQ(inside[square_grid(8).index(0, 1)], 0);
}

TEST(cells_inside, takes_what_of_a_polygon_lies_on_the_grid) {
  const MapPolygon wide{{{{0, 203}, {1000, 203}, {1000, 205}, {0, 205}}}, {}, ""};
  const auto inside = cells_inside({wide}, square_grid(8));
  EXPECT_EQ(std::count(inside.begin(), inside.end(), 1), 16);
  EXPECT_EQ(inside[square_grid(8).index(7, 4)], 1);
}

}  // namespace
}  // namespace talus
