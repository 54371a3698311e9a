// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/regions.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace talus {
namespace {

/// A raster drawn with digits, north first; '.' is nodata.
Raster drawn(const std::vector<std::string>& lines) {
  const int rows = static_cast<int>(lines.size()), columns = static_cast<int>(lines[0].size());
  Raster raster{{columns, rows, 0, 0, 10, ""}, std::vector<double>(static_cast<std::size_t>(rows * columns))};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const char c = lines[static_cast<std::size_t>(rows - 1 - row)][static_cast<std::size_t>(column)];
      raster.at(column, row) = c == '.' ? std::nan("") : c - '0';
    }
  }
  return raster;
}

TEST(regions, join_cells_by_side_and_corner_up_to_nodata_and_are_ordered_by_volume) {
  const auto regions = regions_above(drawn({"1000", "0100", "0010", "0000", "2000"}), 0.5);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].cells.size(), 3u);
  EXPECT_DOUBLE_EQ(regions[0].volume, 300);
  EXPECT_DOUBLE_EQ(regions[1].volume, 200);
  const auto small_and_deep = regions_above(drawn({"1110", "0000", "0009"}), 0.5);
  ASSERT_EQ(small_and_deep.size(), 2u);
  EXPECT_EQ(small_and_deep[0].cells.size(), 1u);
  EXPECT_EQ(regions_above(drawn({"1.1", "1.1"}), 0.5).size(), 2u);
  EXPECT_TRUE(regions_above(drawn({"111", "111"}), 1.0).empty()) << "they only equal the threshold";
  EXPECT_EQ(regions_above(drawn({"121", "111"}), 1.0).size(), 1u);
}

TEST(regions, hold_every_cell_once) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(-1, 1);
  Raster map{{60, 45, 0, 0, 5, ""}, std::vector<double>(60 * 45)};
  for (double& value : map.values) value = part(random);
  std::vector<int> found(map.values.size(), 0);
  double volume = 0;
  for (const Region& region : regions_above(map, 0.4)) {
    volume += region.volume;
    for (std::size_t cell : region.cells) ++found[cell];
  }
  double expected = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i], map.values[i] > 0.4 ? 1 : 0);
    expected += found[i] ? 25 * map.values[i] : 0;
  }
  EXPECT_NEAR(volume, expected, 1e-9 * expected);
}

}  // namespace
}  // namespace talus
