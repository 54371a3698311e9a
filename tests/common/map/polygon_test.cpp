// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/polygon.hpp"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace talus
