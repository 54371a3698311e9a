// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/regions/regions.hpp"

#include "tests/preprocess/terrain.hpp"

namespace talus::preprocess {
namespace {

/// A raster drawn with digits, north first; '.' is nodata.
Raster drawn(const std::vector<std::string>& lines) {
  const int rows = static_cast<int>(lines.size()), columns = static_cast<int>(lines[0].size());
  Raster raster{test::grid_of(columns, rows, 10, 0, 0), std::vector<double>(static_cast<std::size_t>(rows * columns))};
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const char c = lines[static_cast<std::size_t>(rows - 1 - row)][static_cast<std::size_t>(column)];
      raster.at(column, row) = c == '.' ? std::nan("") : c - '0';
    }
  }
  return raster;
}

TEST(regions, join_cells_by_side_and_corner) {
  const auto regions = lowering_regions(drawn({"1000", "0100", "0010", "0000", "2000"}), 0.5);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].cells.size(), 3u);
  EXPECT_DOUBLE_EQ(regions[0].volume, 300);
  EXPECT_DOUBLE_EQ(regions[1].volume, 200);
}

TEST(regions, are_ordered_by_volume_not_by_area) {
  const auto regions = lowering_regions(drawn({"1110", "0000", "0009"}), 0.5);
  ASSERT_EQ(regions.size(), 2u);
  EXPECT_EQ(regions[0].cells.size(), 1u);
}

TEST(regions, leave_out_what_only_equals_the_threshold) {
  EXPECT_TRUE(lowering_regions(drawn({"111", "111"}), 1.0).empty());
  EXPECT_EQ(lowering_regions(drawn({"121", "111"}), 1.0).size(), 1u);
}

TEST(regions, end_at_nodata) { EXPECT_EQ(lowering_regions(drawn({"1.1", "1.1"}), 0.5).size(), 2u); }

TEST(regions, hold_every_lowered_cell_once) {
  TALUS_SEEDED(seed);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> part(-1, 1);
  const Raster lowering = test::raster_of(test::grid_of(60, 45, 5), [&](double, double) { return part(random); });
  std::vector<int> found(lowering.values.size(), 0);
  double volume = 0;
  for (const Region& region : lowering_regions(lowering, 0.4)) {
    volume += region.volume;
    for (std::size_t cell : region.cells) ++found[cell];
  }
  double expected = 0;
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(found[i], lowering.values[i] > 0.4 ? 1 : 0);
    expected += found[i] ? 25 * lowering.values[i] : 0;
  }
  EXPECT_NEAR(volume, expected, 1e-9 * expected);
}

}  // namespace
}  // namespace talus::preprocess
