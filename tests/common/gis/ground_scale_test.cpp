// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths on the map over lengths on the ground.
#include "common/gis/ground_scale.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "common/gis/crs.hpp"

namespace talus {
namespace {

TEST(ground_scale, of_utm_is_its_factor_on_the_central_meridian) {
  const auto scale = ground_scale_at(crs_by_name("EPSG:32633"), 500000, 5100000);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->x, 0.9996, 1e-7);  // the definition of UTM
  EXPECT_NEAR(scale->y, 0.9996, 1e-7);
  EXPECT_NEAR(scale->area, 0.9996 * 0.9996, 1e-7);
}

/// Web Mercator at latitude p: a / (N cos p) along the parallel and a / M along the meridian times sec p, with the
/// radii of curvature N and M (Snyder 1987).
TEST(ground_scale, of_web_mercator_is_that_of_its_latitude) {
  const double a = 6378137, y = 5012341, latitude = 2 * std::atan(std::exp(y / a)) - std::numbers::pi / 2;
  const double e2 = 0.00669437999014, w = 1 - e2 * std::pow(std::sin(latitude), 2);
  const auto scale = ground_scale_at(crs_by_name("EPSG:3857"), -8000000, y);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->x, std::sqrt(w) / std::cos(latitude), 1e-8);
  EXPECT_NEAR(scale->y, std::pow(w, 1.5) / (1 - e2) / std::cos(latitude), 1e-8);
  EXPECT_NEAR(scale->area, 1.74, 0.03) << "at 41 degrees";
}

/// Plate carree: true along meridians, too long along parallels.
TEST(ground_scale, tells_axes_apart) {
  const auto scale = ground_scale_at(crs_by_name("EPSG:32662"), 1000000, 5000000);
  if (!scale) GTEST_SKIP() << "this PROJ does not know EPSG:32662";
  EXPECT_NEAR(scale->y, 1, 0.01);
  EXPECT_GT(scale->x, 1.3);
}

TEST(ground_scale, of_a_grid_is_worst_where_it_is_worst) {
  const MapGrid wide{
      .columns = 1000, .rows = 10, .west = 200000, .south = 100000, .cell = 600, .crs_wkt = crs_by_name("EPSG:32633")};
  const auto scale = grid_scale(wide);
  ASSERT_TRUE(scale.has_value());
  EXPECT_NEAR(scale->middle.x, 0.9996, 1e-6);
  EXPECT_GT(scale->worst.falsity(), 0.0006) << "300 km from the central meridian";
  EXPECT_FALSE(grid_scale(MapGrid{.columns = 9, .rows = 9, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""}));
}

}  // namespace
}  // namespace talus
