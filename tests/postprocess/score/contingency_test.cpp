// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/contingency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "common/map/raster.hpp"

namespace talus::postprocess {
namespace {

TEST(Contingency, counts_areas_on_a_mask_made_by_hand) {
  //                               TP FP FN TN TN  not compared
  const std::vector<double> simulated{2, 3, 0, 0, 1, nan, 5};
  const std::vector<double> surveyed{2, 0, 4, 0, 1, 7, nan};
  const auto c = compare(simulated, 1, surveyed, 1, 25);  // a value equal to the threshold is no
  EXPECT_EQ(c.true_positive, 25);
  EXPECT_EQ(c.false_positive, 25);
  EXPECT_EQ(c.false_negative, 25);
  EXPECT_EQ(c.true_negative, 50);
  EXPECT_DOUBLE_EQ(c.csi(), 1.0 / 3);
  EXPECT_DOUBLE_EQ(c.hit_rate(), 0.5);
  EXPECT_DOUBLE_EQ(c.false_alarm_ratio(), 0.5);
  EXPECT_DOUBLE_EQ(c.foc(), 1.0);
  EXPECT_DOUBLE_EQ(c.hss(), 2.0 * (1 * 2 - 1) / ((2 * 3) + (2 * 3)));
  EXPECT_DOUBLE_EQ(c.d2pc(), std::hypot(0.5, 1.0 / 3));
}

TEST(Contingency, is_perfect_for_equal_maps_and_undefined_for_empty_ones) {
  const std::vector<double> map{0, 3, 5, 0};
  EXPECT_EQ(compare(map, 1, map, 1, 1).csi(), 1);
  EXPECT_EQ(compare(map, 1, map, 1, 1).hss(), 1);
  EXPECT_EQ(compare(map, 1, map, 1, 1).d2pc(), 0);
  const std::vector<double> nothing(4, 0.0);
  EXPECT_TRUE(std::isnan(compare(nothing, 1, nothing, 1, 1).csi()));
}

TEST(Contingency, takes_a_threshold_for_each_side) {
  // A polygon's inside (1) against a thickness.
  EXPECT_EQ(compare({2, 0.8}, 1, {1, 1}, 0.5, 1).true_positive, 1);
  EXPECT_EQ(compare({2, 0.8}, 1, {1, 1}, 0.5, 1).false_negative, 1);
}

TEST(Contingency, makes_a_synthetic_index_of_five_parts) {
  Contingency c;
  c.true_positive = 60, c.false_positive = 20, c.false_negative = 40, c.true_negative = 123456;  // TN has no part in it
  const double csi = 60.0 / 120, tn = 5 * 100 - 20;
  const double hss = 2 * (60 * tn - 20 * 40) / (100 * (40 + tn) + 80 * (20 + tn));
  const double d2pc = std::hypot(0.4, 20.0 / 500);
  const double foc = std::pow(std::sin(1.5707963267948966 * 0.8), 5),
               reach = std::pow(std::sin(1.5707963267948966 * 0.9), 5);
  EXPECT_DOUBLE_EQ(c.spi(0.9), (csi + hss + 1 - d2pc + foc + reach) / 5);
  EXPECT_DOUBLE_EQ(c.spi(0.9), c.spi(1 / 0.9)) << "too far counts as too short by the same ratio";
  EXPECT_TRUE(std::isnan(c.spi(nan)));
  EXPECT_TRUE(std::isnan(Contingency{}.spi(1)));
  const std::vector<double> map{0, 3, 5, 0};
  EXPECT_DOUBLE_EQ(compare(map, 1, map, 1, 1).spi(1), 1);
  EXPECT_NEAR(compare({0, 0, 0, 0}, 1, map, 1, 1).spi(1e-9), 0, 1e-12) << "nothing right is 0, not below";
}

TEST(ThicknessError, is_taken_over_the_union_of_both_deposits) {
  //                               both  sim  survey  neither  not surveyed
  const std::vector<double> simulated{4, 3, 0, 0.5, 9};
  const std::vector<double> surveyed{2, 0, 6, 0.9, nan};
  const auto error = thickness_error(simulated, surveyed, 1);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((4.0 + 9 + 36) / 3));
  EXPECT_DOUBLE_EQ(error.bias, (2.0 + 3 - 6) / 3);
  EXPECT_DOUBLE_EQ(error.mean_absolute, 11.0 / 3);
  EXPECT_DOUBLE_EQ(error.median, 2) << "of 2, 3 and -6";
  EXPECT_DOUBLE_EQ(error.nmad, 1.4826) << "distances from it 0, 1 and 8";
  EXPECT_TRUE(std::isnan(thickness_error({0}, {0}, 1).rmse));
  EXPECT_TRUE(std::isnan(thickness_error({0}, {0}, 1).nmad));
}

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
