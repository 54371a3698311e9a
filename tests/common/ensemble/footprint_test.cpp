// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/footprint.hpp"

#include <gtest/gtest.h>

#include "common/map/raster.hpp"

namespace talus {
namespace {

TEST(Footprint, comes_back_as_it_went) {
  for (const std::vector<double>& thickness_map :
       {std::vector<double>{0, 0, 1, 2, 0}, {1, 1, 1}, {0, 0}, {nan, 3, nan, 3}, {}}) {
    const auto cells = cells_of(footprint_of(thickness_map, 0.5), thickness_map.size());
    ASSERT_EQ(cells.size(), thickness_map.size());
    for (std::size_t n = 0; n < cells.size(); ++n) EXPECT_EQ(cells[n] != 0, thickness_map[n] > 0.5) << "cell " << n;
  }
}

TEST(Footprint, holds_what_is_thicker_than_the_threshold_and_not_as_thick) {
  EXPECT_EQ(footprint_of(std::vector<double>{0.5, 0.51}, 0.5), (Footprint{1, 1}));
}

TEST(Footprint, counts_the_cells_that_it_covers) {
  EXPECT_EQ(covered_cells(footprint_of(std::vector<double>{1, 0, 1, 1, nan, 2}, 0.5)), 4);
  EXPECT_EQ(covered_cells(footprint_of(std::vector<double>{0, 0}, 0.5)), 0);
  EXPECT_EQ(covered_cells({}), 0);
}

}  // namespace
}  // namespace talus
