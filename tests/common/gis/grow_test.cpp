// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/grow.hpp"

#include <cmath>
#include <numbers>

#include "tests/common/scratch.hpp"

namespace talus {
namespace {

double area_within(const std::vector<MapPolygon>& polygons) {
  double twice = 0;
  for (const MapPolygon& polygon : polygons)
    for (std::size_t r = 0; r < polygon.rings.size(); ++r) {
      const auto& ring = polygon.rings[r];
      double own = 0;
      for (std::size_t i = 0; i < ring.size(); ++i) {
        const auto &a = ring[i], &b = ring[(i + 1) % ring.size()];
        own += a[0] * b[1] - b[0] * a[1];
      }
      twice += (r == 0 ? 1 : -1) * std::abs(own);
    }
  return twice / 2;
}

/// 100 x 60 m with a hole of 20 x 20 m, and two numbers.
const MapPolygon holed{
    {{{0, 0}, {100, 0}, {100, 60}, {0, 60}}, {{40, 20}, {40, 40}, {60, 40}, {60, 20}}}, {{"thickness", 4.5}}, "scar"};

TEST(Grown, outlines_have_the_area_around_them) {
  const auto wider = grown({holed}, 5, "a.gpkg");
  ASSERT_EQ(wider.size(), 1u);
  const double outer = 6000 + 2 * 160 * 5 + std::numbers::pi * 25, hole = 100;
  EXPECT_NEAR(area_within(wider), outer - hole, 0.1) << "corners are round to a thousandth of 5 m";
  EXPECT_EQ(wider[0].numbers, holed.numbers);
  EXPECT_EQ(wider[0].name, "scar");
  const auto without_hole = grown({holed}, 12, "a.gpkg");
  EXPECT_EQ(without_hole[0].rings.size(), 1u);
}

TEST(Grown, outlines_shrink_and_may_fall_apart) {
  const auto narrower = grown({holed}, -5, "a.gpkg");
  EXPECT_NEAR(area_within(narrower), 90 * 50 - (400 + 80 * 5 + std::numbers::pi * 25), 0.1);
  const MapPolygon neck{{{{0, 0},
                          {40, 0},
                          {40, 18},
                          {60, 18},
                          {60, 0},
                          {100, 0},
                          {100, 40},
                          {60, 40},
                          {60, 22},
                          {40, 22},
                          {40, 40},
                          {0, 40}}},
                        {},
                        ""};
  EXPECT_EQ(grown({neck}, -3, "a.gpkg").size(), 2u);
  EXPECT_EQ(grown({holed}, 0, "a.gpkg")[0].rings, holed.rings);
}

TEST(Grown, nothing_left_is_refused) {
  EXPECT_TRUE(test::holds(test::fault_of<DataError>([] { grown({holed}, -20, "a.gpkg"); }),
                          {"a.gpkg: nothing is left of it with grow_m = -20"}));
}

}  // namespace
}  // namespace talus
