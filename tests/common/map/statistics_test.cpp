// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/statistics.hpp"

#include "common/map/usual_reach.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus {
namespace {

TEST(Statistics, takes_quantiles_between_the_sorted_values) {
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2, 5}, 0.5), 3);
  EXPECT_DOUBLE_EQ(quantile({4, 1, 3, 2}, 0.5), 2.5);
  EXPECT_DOUBLE_EQ(quantile({10, 0}, 0.05), 0.5);
  EXPECT_DOUBLE_EQ(quantile({7, 8, 9}, 1), 9);
  EXPECT_TRUE(std::isnan(quantile({}, 0.5)));
}

TEST(Statistics, takes_the_99th_percentile_of_what_is_above_0) {
  std::vector<double> map(1000, 0.0);
  map[3] = std::nan("");
  for (int n = 1; n <= 101; ++n) map[static_cast<std::size_t>(5 * n)] = n;
  EXPECT_DOUBLE_EQ(p99_of_positive(map), 100) << "cells without anything do not count";
  EXPECT_TRUE(std::isnan(p99_of_positive({0, 0, std::nan("")})));
}

TEST(Statistics, nmad_does_not_see_an_outlier) {
  EXPECT_DOUBLE_EQ(nmad({1, 2, 3, 4, 1000}), 1.4826) << "median 3, distances 2 1 0 1 997";
  EXPECT_TRUE(std::isnan(nmad({})));
}

TEST(Statistics, spread_leaves_out_draws_without_a_value) {
  const auto spread = spread_of({1, std::nan(""), 3});
  EXPECT_DOUBLE_EQ(spread.mean, 2);
  EXPECT_DOUBLE_EQ(spread.deviation, std::sqrt(2.0));
  EXPECT_DOUBLE_EQ(spread.low, 1.1);
  EXPECT_DOUBLE_EQ(spread.high, 2.9);
  EXPECT_EQ(spread_of({5}).deviation, 0);
  EXPECT_TRUE(std::isnan(spread_of({}).mean));
}

TEST(Statistics, half_of_the_volume_stands_in_columns_thicker_than_the_median) {
  const MapGrid grid{10, 10, 0, 0, 20, ""};
  Raster rim{grid, std::vector<double>(grid.count(), 1.0)};  // half of the columns, a tenth of the volume
  for (std::size_t n = 0; n < rim.values.size() / 2; ++n) rim.values[n] = 9;
  EXPECT_EQ(median_thickness(rim), 9.0);
  for (double& t : rim.values) t = 0;
  EXPECT_EQ(median_thickness(rim), 0);
}

/// Frank Slide, 36 million m3: H/L of 0.28 (Scheidegger) and 0.20 (Corominas); about 0.25 was observed.
TEST(UsualReach, holds_the_published_regressions) {
  const auto regressions = reach_regressions();
  ASSERT_EQ(regressions.size(), 2u);
  EXPECT_NEAR(regressions[0].tangent(36e6), 0.2757, 1e-3);
  EXPECT_NEAR(regressions[1].tangent(36e6), 0.2045, 1e-3);
  EXPECT_NEAR(regressions[1].tangent(1e6), 0.2773, 1e-3);  // 10^(-0.047 - 0.51)
}

TEST(UsualReach, is_bounded_by_those_that_hold_for_a_volume) {
  const ReachBounds large = usual_reach(36e6), small = usual_reach(5e4), none = usual_reach(10);
  EXPECT_NEAR(large.low, 0.2045 / 2, 1e-3);
  EXPECT_NEAR(large.high, 0.2757 * 2, 1e-3);
  EXPECT_NEAR(small.high / small.low, 4, 1e-9);  // one regression alone
  EXPECT_EQ(none.high, 0);
}

}  // namespace
}  // namespace talus
