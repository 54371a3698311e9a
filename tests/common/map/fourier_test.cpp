// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Waves taken apart and put together again.
#include "common/map/fourier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace talus {
namespace {

TEST(fourier_length, has_no_prime_factor_beyond_five) {
  EXPECT_EQ(fourier_length(1), 1);
  EXPECT_EQ(fourier_length(7), 8);
  EXPECT_EQ(fourier_length(97), 100);
  EXPECT_EQ(fourier_length(2032), 2048);
}

TEST(fourier_transform, finds_one_wave_at_its_place_and_gives_it_back) {
  constexpr int wide = 12, high = 10, along_x = 3, along_y = 8;
  std::vector<std::complex<double>> plane;
  for (int row = 0; row < high; ++row)
    for (int column = 0; column < wide; ++column)
      plane.push_back(
          std::polar(2.0, 2 * std::numbers::pi * (column * double(along_x) / wide + row * double(along_y) / high)));
  const auto wave = plane;
  fourier_transform(plane, wide, high);
  for (std::size_t i = 0; i < plane.size(); ++i)
    EXPECT_NEAR(std::abs(plane[i] - (i == along_y * wide + along_x ? 2.0 * wide * high : 0.0)), 0, 1e-11) << i;
  inverse_fourier_transform(plane, wide, high);
  for (std::size_t i = 0; i < plane.size(); ++i) EXPECT_NEAR(std::abs(plane[i] - wave[i]), 0, 1e-13);
}

}  // namespace
}  // namespace talus
