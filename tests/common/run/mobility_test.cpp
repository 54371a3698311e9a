// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/run/mobility.hpp"

#include <limits>

#include <gtest/gtest.h>

namespace talus {
namespace {

TEST(CoveringThickness, is_a_tenth_of_a_metre_for_thick_releases_and_follows_thin_ones) {
  EXPECT_EQ(covering_thickness({30, 40, 50}), 0.1);
  EXPECT_EQ(covering_thickness({2, 2, 2}), 0.1);
  EXPECT_EQ(covering_thickness({1, 1, 1.5}), 0.05);
  EXPECT_EQ(covering_thickness({0.02, 0.02, 0.02}), 0.001);
  EXPECT_EQ(covering_thickness({0.8137}), 0.041) << "two digits";
}

TEST(CoveringThickness, looks_at_released_cells_alone) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(covering_thickness({}), 0.1);
  EXPECT_EQ(covering_thickness({0, none, 0}), 0.1);
  EXPECT_EQ(covering_thickness({0, 0, 0, 0, none, 1, 1}), 0.05);
}

}  // namespace
}  // namespace talus
