// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/polyline.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace talus::postprocess {
namespace {

TEST(Polyline, is_walked_in_even_steps) {
  const Polyline bend{{0, 0}, {30, 0}, {30, 40}};
  EXPECT_EQ(lengths_along(bend), (std::vector<double>{0, 30, 70}));
  const auto even = resampled(bend, 10.4);  // 70 m: seven steps of 10 m come nearest
  ASSERT_EQ(even.size(), 8u);
  EXPECT_EQ(even[3], (std::array<double, 2>{30, 0}));
  EXPECT_EQ(even[5], (std::array<double, 2>{30, 20}));
  EXPECT_EQ(even.back(), bend.back());
}

TEST(Polyline, keeps_its_ends_and_loses_its_corners_when_smoothed) {
  const Polyline corner{{0, 0}, {10, 0}, {10, 10}};
  const auto once = smoothed(corner, 1);
  EXPECT_EQ(once.front(), corner.front());
  EXPECT_EQ(once.back(), corner.back());
  EXPECT_EQ(once[1], (std::array<double, 2>{7.5, 2.5}));
}

TEST(Polyline, drops_what_goes_back_on_itself) {
  const Polyline restless{{0, 0}, {10, 0}, {11, 0}, {20, 1}, {14, 3}, {30, 2}, {28, 2}};
  const auto straight = without_returns(restless, 5);
  EXPECT_EQ(straight, (Polyline{{0, 0}, {10, 0}, {20, 1}, {28, 2}})) << "near points and returns go, the last stays";
  EXPECT_EQ(without_returns({{3, 4}}, 5).size(), 1u);
}

}  // namespace
}  // namespace talus::postprocess
