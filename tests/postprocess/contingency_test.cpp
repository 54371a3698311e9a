#include "postprocess/score/contingency.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace talus::postprocess {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

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

TEST(ThicknessError, is_taken_over_the_union_of_both_deposits) {
  //                               both  sim  survey  neither  not surveyed
  const std::vector<double> simulated{4, 3, 0, 0.5, 9};
  const std::vector<double> surveyed{2, 0, 6, 0.9, nan};
  const auto error = thickness_error(simulated, surveyed, 1);
  EXPECT_DOUBLE_EQ(error.rmse, std::sqrt((4.0 + 9 + 36) / 3));
  EXPECT_DOUBLE_EQ(error.bias, (2.0 + 3 - 6) / 3);
  EXPECT_DOUBLE_EQ(error.mean_absolute, 11.0 / 3);
  EXPECT_TRUE(std::isnan(thickness_error({0}, {0}, 1).rmse));
}

}  // namespace
}  // namespace talus::postprocess
