// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points of the surfaces of obstacles.
#include "solver/boundary/contact_points.hpp"

#include <gtest/gtest.h>

#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {
namespace {

TEST(ContactPoints, refuse_an_obstacle_without_a_file) {
  Domain d = ground(14, 12, 2, 1.0, [](double x, double y) { return 20 + 0.3 * x - 0.2 * y; });
  fill(d, {10, 14, 8, 12, 0, 2});
  const Scene scene = make_scene(d, {});
  EXPECT_EQ(scene.contacts.size(), 0u) << "there are no points without obstacles";
  EXPECT_THROW(
      make_contact_points(scene.map, scene.grid, make_terrain_tables(scene.grid), {{"pier", "/no/such.vdb", "", 0}}),
      DataError);
}

}  // namespace
}  // namespace talus::solver::testing
