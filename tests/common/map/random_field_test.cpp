// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/random_field.hpp"

#include "common/map/fourier.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace talus {
namespace {

const MapGrid field_grid{.columns = 50, .rows = 37, .west = 0, .south = 0, .cell = 10, .crs_wkt = ""};

/// Mean product of cells (dx, dy) apart, over many fields: the covariance, because the mean is 0 by construction.
double covariance(double range, int dx, int dy) {
  RandomField field(field_grid, range, 7);
  double sum = 0, count = 0;
  for (int draw = 0; draw < 400; ++draw) {
    const auto v = field.next();
    for (int row = 0; row + dy < field_grid.rows; ++row)
      for (int column = 0; column + dx < field_grid.columns; ++column) {
        sum += v[field_grid.index(column, row)] * v[field_grid.index(column + dx, row + dy)];
        ++count;
      }
  }
  return sum / count;
}

// 400 fields of about 1850 / (8 x 8) independent patches: a standard error near 0.01 for the variance; 0.04 is four of
// them.
constexpr double chance = 0.04;

TEST(RandomField, has_unit_variance_and_spherical_correlation) {
  EXPECT_NEAR(covariance(80, 0, 0), 1, chance);
  EXPECT_NEAR(covariance(80, 4, 0), 1 - 1.5 * 0.5 + 0.5 * 0.125, chance) << "half the range: 0.3125";
  EXPECT_NEAR(covariance(80, 0, 4), 0.3125, chance) << "the same northwards";
  EXPECT_NEAR(covariance(80, 3, 4), 1 - 1.5 * 0.625 + 0.5 * std::pow(0.625, 3), chance) << "and askew: five cells";
  EXPECT_NEAR(covariance(80, 8, 0), 0, chance) << "nothing is left at the range";
  EXPECT_NEAR(covariance(80, 48, 0), 0, chance) << "opposite edges do not know each other";
}

TEST(RandomField, has_no_correlation_without_a_range) {
  EXPECT_NEAR(covariance(0, 0, 0), 1, 0.01);  // 740 000 independent values: a standard error of 0.0016
  EXPECT_NEAR(covariance(0, 1, 0), 0, 0.01);
}

TEST(RandomField, is_the_same_for_the_same_seed_and_never_twice_in_a_row) {
  RandomField one(field_grid, 80, 5), same(field_grid, 80, 5), other(field_grid, 80, 6);
  const auto first = one.next(), second = one.next(), third = one.next();
  EXPECT_EQ(first, same.next());
  EXPECT_EQ(second, same.next());
  EXPECT_EQ(third, same.next());
  EXPECT_NE(first, other.next());
  EXPECT_NE(first, second);
  EXPECT_NE(first, third);
  other.start(5);
  EXPECT_EQ(other.next(), first) << "a series that is begun again";
  EXPECT_EQ(other.next(), second);
}

TEST(RandomField, takes_ranges_far_beyond_the_map) {
  RandomField field({.columns = 8, .rows = 8, .west = 0, .south = 0, .cell = 1, .crs_wkt = ""}, 1e9, 1);
  const auto v = field.next();
  for (const double value : v) EXPECT_NEAR(value, v[0], 3) << "nearly one value: the range counts as 24 cells";
}

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
