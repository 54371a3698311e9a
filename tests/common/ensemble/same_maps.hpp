// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether the counts of two ensembles are the same, in whichever order members came to their cells.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/ensemble/counts.hpp"

namespace talus::test {

inline void expect_same_blocks(const KeptCells& a, const KeptCells& b) {
  std::vector<std::int32_t> ours = a.blocks(), theirs = b.blocks();
  std::sort(ours.begin(), ours.end());
  std::sort(theirs.begin(), theirs.end());
  EXPECT_EQ(ours, theirs);
}

inline std::vector<std::uint32_t> histogram_of(const EnsembleCounts& counts, std::size_t map, int column, int row) {
  const std::size_t place = counts.cells.find(column, row);
  if (place == KeptCells::none || counts.maps[map].histograms.of(place).empty()) return {};
  const auto bins = counts.maps[map].histograms.of(place);
  return {bins.begin(), bins.end()};
}

/// Cells, counts, sums and histograms, bit for bit.
inline void expect_same_maps(const EnsembleCounts& a, const EnsembleCounts& b) {
  expect_same_blocks(a.cells, b.cells);
  for (std::size_t m = 0; m < a.maps.size(); ++m) {
    SCOPED_TRACE(counted_maps[m].name);
    const MapTally &ours = a.maps[m], &theirs = b.maps[m];
    EXPECT_EQ(ours.thresholds, theirs.thresholds);
    for (std::size_t n = 0; n < ours.exceeded.size(); ++n)
      EXPECT_EQ(a.cells.spread(ours.exceeded[n], 0u), b.cells.spread(theirs.exceeded[n], 0u));
    EXPECT_EQ(a.cells.spread(ours.reached, 0u), b.cells.spread(theirs.reached, 0u));
    EXPECT_EQ(a.cells.spread(ours.extreme, -1), b.cells.spread(theirs.extreme, -1));
    EXPECT_EQ(a.cells.spread(ours.sum, std::int64_t{0}), b.cells.spread(theirs.sum, std::int64_t{0}));
    EXPECT_EQ(a.cells.spread(ours.sum_of_squares, std::int64_t{0}),
              b.cells.spread(theirs.sum_of_squares, std::int64_t{0}));
    for (int row = 0; row < a.scene.grid.rows; ++row)
      for (int column = 0; column < a.scene.grid.columns; ++column)
        EXPECT_EQ(histogram_of(a, m, column, row), histogram_of(b, m, column, row)) << column << ", " << row;
  }
}

}  // namespace talus::test
