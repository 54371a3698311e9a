// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/contingency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/map/raster.hpp"

namespace talus::postprocess {
namespace {

TEST(Residual, is_measured_in_units_of_sigma) {
  //                                       r:  1    -2   0.5   no sigma  not surveyed  not counted
  const auto r = residual_of({3, 1, 2.5, 9, 9, 9}, {2, 2, 2, 1, nan, 1}, {1, 0.5, 1, 0, 1, 1}, {1, 1, 1, 1, 1, 0});
  EXPECT_EQ(r.cells, 3u);
  EXPECT_DOUBLE_EQ(r.median, 0.5);
  EXPECT_DOUBLE_EQ(r.within, 2.0 / 3);
  EXPECT_DOUBLE_EQ(r.chi_squared, (1 + 4 + 0.25) / 3);
}

TEST(Residual, has_no_value_without_a_cell) {
  const auto r = residual_of({3}, {2}, {1}, {0});
  EXPECT_EQ(r.cells, 0u);
  EXPECT_TRUE(std::isnan(r.chi_squared));
}

}  // namespace
}  // namespace talus::postprocess
