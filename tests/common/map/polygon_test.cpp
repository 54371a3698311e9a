// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/polygon.hpp"

#include "common/map/cells_inside.hpp"
#include "common/map/places.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace talus {
namespace {

TEST(Polygon, knows_how_far_its_edge_is_and_on_which_side) {
  // A square of 10 m with a hole of 2 m in its middle.
  const MapPolygon square{
      .rings = {{{0, 0}, {10, 0}, {10, 10}, {0, 10}}, {{4, 4}, {4, 6}, {6, 6}, {6, 4}}}, .numbers = {}, .name = {}};
  EXPECT_DOUBLE_EQ(signed_distance(square, 2, 5), -2);
  EXPECT_DOUBLE_EQ(signed_distance(square, 5, 5), 1) << "in the hole";
  EXPECT_DOUBLE_EQ(signed_distance(square, 13, 14), 5) << "from the corner";
  EXPECT_DOUBLE_EQ(signed_distance(square, 5, -0.5), 0.5);
}

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

TEST(Places, come_back_to_a_centimetre) {
  const MapPlace gauge{"gauge bridge; south", {{{500050.126, 5000100}}}};
  const MapPlace wall{"obstacle \"wall\"", {{{0, 0}, {4, 0}, {4, 100.5}}, {{-1, -1}, {-2, -1}, {-1, -2}}}};
  const auto places = places_in(places_json({gauge, wall}));
  ASSERT_TRUE(places);
  ASSERT_EQ(places->size(), 2U);
  EXPECT_EQ(places->at(0).words, gauge.words);
  EXPECT_EQ(places->at(0).rings.at(0).at(0)[0], 500050.13);
  EXPECT_EQ(places->at(1), wall);
}

TEST(Places, that_are_none_are_refused) {
  const auto ring = [](const std::string& text) { return R"([{"words": "gauge a", "rings": [)" + text + "]}]"; };
  EXPECT_TRUE(places_in(ring("[[1, 2]]")));
  for (const std::string& text : {std::string(), std::string("{}"), std::string("[{}]"), ring("[]"), ring("[[1]]"),
                                  ring("[[1, null]]"), ring("[[1, \"2\"]]"), ring("[[1, 1e999]]"), ring("1")})
    EXPECT_FALSE(places_in(text)) << text;
}

}  // namespace
}  // namespace talus
