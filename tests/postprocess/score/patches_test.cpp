// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/resample.hpp"

#include <gtest/gtest.h>

namespace talus::postprocess {
namespace {

TEST(Patches, keeps_those_that_hold_a_seed) {
  const MapGrid grid{.columns = 4, .rows = 3, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""};
  const std::vector<double> values{5, 0, 0,   4,  //
                                   0, 5, 0,   4,  //
                                   0, 0, 0.5, 0};
  std::vector<char> seeds(12, 0);
  seeds[0] = seeds[2] = 1;                      // the second on a cell below the threshold: no patch
  const std::vector<double> kept{5, 0, 0,   0,  //
                                 0, 5, 0,   0,  //
                                 0, 0, 0.5, 0};
  EXPECT_EQ(patches_with(grid, values, 1, seeds), kept) << "corners join, values below the threshold stay as they are";
}

}  // namespace
}  // namespace talus::postprocess
