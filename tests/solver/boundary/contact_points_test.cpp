// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points of the ground where it is met between the nodes of a Cartesian grid.
#include "solver/boundary/contact_points.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

constexpr double along_x = 0.3, along_y = -0.2, cell = 2;

/// A scene over a plane whose ground is met by points, or by nodes.
Scene over_a_plane(GroundContact contact) {
  Domain d = ground(14, 12, cell, 1.0, [](double x, double y) { return 20 + along_x * x + along_y * y; });
  fill(d, {10, 14, 8, 12, 0, 2});
  SolveOptions o;
  o.mapping = Mapping::cartesian;
  o.ground_contact = contact;
  return make_scene(d, o);
}

TEST(ContactPoints, of_a_plane_lie_on_it_and_know_its_normal) {
  const Scene scene = over_a_plane(GroundContact::points);
  const ContactPoints& points = scene.contacts;
  ASSERT_GT(points.size(), 14u * 12u) << "finer than the nodes";
  const double steep = std::sqrt(1 + along_x * along_x + along_y * along_y);
  int inside = 0;
  const double datum = make_terrain_tables(scene.grid).datum;
  for (std::size_t c = 0; c < points.size(); ++c) {
    if (points.cell[0][c] < 3 || points.cell[0][c] > 10 || points.cell[1][c] < 3 || points.cell[1][c] > 8) continue;
    ++inside;  // where the spline does not feel the edge of the map
    const auto at = [&](int a) { return points.cell[a][c] + points.offset[a][c]; };
    const double x = scene.map.x(0) + cell * at(0), y = scene.map.y(0) + cell * at(1);
    // The spline through a plane is that plane, up to the rounding of its coefficients.
    EXPECT_NEAR(datum + at(2) * scene.grid.layer_height, 20 + along_x * x + along_y * y, 1e-9);
    EXPECT_NEAR(points.normal[c].x, -along_x / steep, 1e-9);
    EXPECT_NEAR(points.normal[c].y, -along_y / steep, 1e-9);
    EXPECT_NEAR(points.normal[c].z, 1 / steep, 1e-9);
    EXPECT_EQ(points.body[c], ContactPoints::ground);
    for (const auto& offset : points.offset) {
      EXPECT_GE(offset[c], -0.5);
      EXPECT_LT(offset[c], 0.5);
    }
  }
  EXPECT_GT(inside, 8 * 6);
}

TEST(ContactPoints, share_the_area_of_the_cells_that_they_stand_for) {
  const Scene scene = over_a_plane(GroundContact::points);
  const ContactPoints& points = scene.contacts;
  const double steep = std::sqrt(1 + along_x * along_x + along_y * along_y);
  double area = 0;
  for (std::size_t c = 0; c < points.size(); ++c) {
    if (points.cell[0][c] == 6 && points.cell[1][c] == 5) area += points.area[c];
  }
  EXPECT_NEAR(area, cell * cell * steep, 1e-9 * cell * cell);
}

TEST(ContactPoints, are_not_there_where_nodes_meet_the_ground) {
  EXPECT_EQ(over_a_plane(GroundContact::nodes).contacts.size(), 0u);
}

TEST(ContactPoints, refuse_an_obstacle_without_a_file) {
  const Scene scene = over_a_plane(GroundContact::nodes);
  EXPECT_THROW(
      make_contact_points(scene.map, scene.grid, make_terrain_tables(scene.grid), {{"pier", "/no/such.vdb", "", 0}}),
      DataError);
}

}  // namespace
}  // namespace talus::solver::testing
