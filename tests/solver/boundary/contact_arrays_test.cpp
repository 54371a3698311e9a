// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points on a device: what kernels are shown, and the history that a checkpoint keeps.
#include "solver/boundary/contact_arrays.hpp"

#include <gtest/gtest.h>

namespace talus::solver::testing {
namespace {

/// Two points, one of each obstacle.
ContactPoints two_points() {
  ContactPoints points;
  for (int a = 0; a < 3; ++a) {
    points.cell[a] = {3 + a, 7 + a};
    points.offset[a] = {0.1 * a, -0.2 * a};
  }
  points.normal = {{0.6, 0, 0.8}, {0, 0, 1}};
  points.area = {0.3, 0.7};
  points.body = {0, 1};
  points.friction = {0.9, 0.2};
  return points;
}

TEST(ContactArrays, show_kernels_every_number_of_the_points) {
  const ContactPoints points = two_points();
  ContactArrays<float, CpuDevice> arrays(CpuDevice::make(), points, {});
  const ContactView<float> view = arrays.view();
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_EQ(view.places.cell[a][c], points.cell[a][c]);
      EXPECT_EQ(view.places.offset[a][c], static_cast<float>(points.offset[a][c]));
      EXPECT_EQ(view.places.extent[a][c], 0);
    }
    EXPECT_EQ(view.normal[c].x, static_cast<float>(points.normal[c].x));
    EXPECT_EQ(view.normal[c].z, static_cast<float>(points.normal[c].z));
    EXPECT_EQ(view.area[c], static_cast<float>(points.area[c]));
    EXPECT_EQ(view.body[c], points.body[c]);
    EXPECT_EQ(view.inverse_mass[c], 0);
    EXPECT_EQ(length(view.force[c]), 0);
    EXPECT_EQ(length(view.impulse[c]), 0);
  }
  EXPECT_EQ(view.body_friction[0], 0.9F);
  EXPECT_EQ(view.friction(1), 0.2F);
}

TEST(ContactArrays, go_on_from_the_state_of_a_checkpoint) {
  const ContactState before{.force = {1, 2, 3, 4, 5, 6}, .impulse = {7, 8, 9, 10, 11, 12}};
  ContactArrays<double, CpuDevice> arrays(CpuDevice::make(), two_points(), before);
  const ContactView<double> view = arrays.view();
  EXPECT_EQ(view.force[1].y, 5);
  EXPECT_EQ(view.impulse[0].z, 9);
  view.force[0] = {-1, 0, 0};
  view.impulse[1].x += 5;
  EXPECT_EQ(arrays.impulses()[1].x, 15);
  const ContactState after = arrays.state();
  EXPECT_EQ(after.force, (std::vector<double>{-1, 0, 0, 4, 5, 6}));
  EXPECT_EQ(after.impulse, (std::vector<double>{7, 8, 9, 15, 11, 12}));
}

TEST(ContactArrays, take_no_memory_without_points) {
  const ContactArrays<double, CpuDevice> arrays(CpuDevice::make(), {}, {});
  EXPECT_EQ(arrays.bytes(), 0u);
  EXPECT_TRUE(arrays.state().force.empty());
}

}  // namespace
}  // namespace talus::solver::testing
