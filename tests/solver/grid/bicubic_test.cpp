// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The surface between the nodes of a Cartesian grid: through its nodes, smooth, exact for planes.
#include "solver/grid/bicubic.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace talus {
namespace {

constexpr int ground_columns = 9, ground_rows = 8;
constexpr double spacing = 2;

std::vector<double> terrain(double (*height)(double, double)) {
  std::vector<double> values;
  for (int j = 0; j < ground_rows; ++j) {
    for (int i = 0; i < ground_columns; ++i) values.push_back(height(i * spacing, j * spacing));
  }
  return values;
}

GroundPoint<double> at(const std::vector<double>& values, int i, int j, double x, double y) {
  return bicubic_ground(NodeTerrain<double>{values.data(), ground_columns, ground_rows, spacing}, i, j, x, y);
}

TEST(bicubic, goes_through_its_nodes) {
  const auto values = terrain([](double x, double y) { return std::sin(x) + 0.3 * y * y; });
  for (int j = 2; j < ground_rows - 2; ++j) {
    for (int i = 2; i < ground_columns - 2; ++i)
      EXPECT_NEAR(at(values, i, j, 0, 0).height, values[static_cast<std::size_t>(j * ground_columns + i)], 1e-13);
  }
}

TEST(bicubic, is_exact_for_planes_with_their_slopes) {
  const auto values = terrain([](double x, double y) { return 3 + 0.5 * x - 0.25 * y; });
  const GroundPoint<double> g = at(values, 4, 3, 0.3, -0.4);
  EXPECT_NEAR(g.height, 3 + 0.5 * 4.3 * spacing - 0.25 * 2.6 * spacing, 1e-13);
  EXPECT_NEAR(g.slope_x, 0.5, 1e-13);
  EXPECT_NEAR(g.slope_y, -0.25, 1e-13);
}

// Catmull-Rom is exact for quadratics, whose central differences are their slopes.
TEST(bicubic, is_exact_for_quadratics_inside) {
  const auto values = terrain([](double x, double y) { return 0.1 * x * x + 0.05 * x * y; });
  const double x = 4.4 * spacing, y = 3.7 * spacing;
  const GroundPoint<double> g = at(values, 4, 4, 0.4, -0.3);
  EXPECT_NEAR(g.height, 0.1 * x * x + 0.05 * x * y, 1e-12);
  EXPECT_NEAR(g.slope_x, 0.2 * x + 0.05 * y, 1e-12);
}

TEST(bicubic, slopes_are_the_derivatives_of_the_height) {
  const auto values = terrain([](double x, double y) { return std::sin(0.7 * x) * std::cos(0.4 * y); });
  constexpr double step = 1e-6;
  const GroundPoint<double> g = at(values, 4, 3, 0.2, 0.3);
  const double dx = (at(values, 4, 3, 0.2 + step, 0.3).height - at(values, 4, 3, 0.2 - step, 0.3).height) / (2 * step);
  EXPECT_NEAR(g.slope_x, dx / spacing, 1e-9);  // of central differences: step^2 and rounding over step
}

TEST(bicubic, is_read_from_either_side_of_a_node_alike) {
  const auto values = terrain([](double x, double y) { return std::cos(x + 0.5 * y); });
  const GroundPoint<double> from_left = at(values, 3, 3, 0.8, 0.1), from_right = at(values, 4, 3, -0.2, 0.1);
  EXPECT_NEAR(from_left.height, from_right.height, 1e-14);
  EXPECT_NEAR(from_left.slope_x, from_right.slope_x, 1e-14);
}

}  // namespace
}  // namespace talus
