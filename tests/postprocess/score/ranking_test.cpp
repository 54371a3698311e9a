// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/contingency.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "common/map/raster.hpp"

namespace talus::postprocess {
namespace {

TEST(Auroc, counts_pairs_and_halves_ties) {
  // Survey yes at 5, 2, 0; no at 3, 0, 0. Pairs won: 5 beats all three; 2 beats two; 0 ties with two: (3 + 2 + 1) / 9.
  EXPECT_DOUBLE_EQ(auroc({5, 2, 0, 3, 0, 0, 9, nan}, {4, 4, 4, 0, 1, 0, nan, 4}, 1), 6.0 / 9);
}

TEST(Auroc, is_one_for_perfect_order_and_a_half_for_none) {
  EXPECT_EQ(auroc({4, 3, 2, 1}, {9, 9, 0, 0}, 1), 1);
  EXPECT_EQ(auroc({1, 2, 3, 4}, {9, 9, 0, 0}, 1), 0);
  EXPECT_EQ(auroc({1, 1, 1, 1}, {9, 9, 0, 0}, 1), 0.5);
  EXPECT_TRUE(std::isnan(auroc({1, 2}, {9, 9}, 1)));
}

}  // namespace
}  // namespace talus::postprocess
