// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The likelihood of a survey against closed forms; means over blocks and the covariance of their errors.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <random>
#include <stdexcept>

#include "common/map/limits.hpp"
#include "postprocess/ensemble/block_means.hpp"
#include "postprocess/ensemble/likelihood.hpp"

namespace talus::postprocess {
namespace {

double log_normal(double residual, double variance) {
  return -0.5 * (residual * residual / variance + std::log(2 * std::numbers::pi * variance));
}

TEST(Likelihood, of_one_number_is_normal_with_both_variances) {
  const Likelihood likelihood({"speed", "m/s", {30}, {}, {4}, 30, 0, 0});
  const std::vector<double> found = likelihood.by_discrepancy({{27.0}, {}});
  ASSERT_EQ(found.size(), likelihood.table().size());
  for (std::size_t n = 0; n < found.size(); ++n) {
    const Discrepancy& one = likelihood.table()[n];
    EXPECT_EQ(one.length, 0);
    EXPECT_NEAR(found[n], log_normal(3, 4 + one.deviation * one.deviation), 1e-12);
  }
  EXPECT_NEAR(likelihood.table().front().deviation, 1.5, 1e-12);
  EXPECT_NEAR(likelihood.table().back().deviation, 60, 1e-12);
}

/// Two correlated numbers are independent along their sum and their difference.
TEST(Likelihood, of_two_places_has_the_correlation_of_their_distance) {
  const double distance = 30, r1 = 0.7, r2 = -0.2, error = 0.09;
  const Likelihood likelihood({"thickness", "m", {2, 1}, {{0, 0}, {distance, 0}}, {error, 0, 0, error}, 1.5, 10, 100});
  const std::vector<double> found = likelihood.by_discrepancy({{2 - r1, 1 - r2}, {}});
  for (std::size_t n = 0; n < found.size(); ++n) {
    const auto& [deviation, length] = likelihood.table()[n];
    const double variance = deviation * deviation, alike = variance * std::exp(-distance / length);
    const double exact = log_normal((r1 + r2) / std::sqrt(2), error + variance + alike) +
                         log_normal((r1 - r2) / std::sqrt(2), error + variance - alike);
    EXPECT_NEAR(found[n], exact, 1e-10);
  }
}

TEST(Likelihood, estimates_a_discrepancy_that_is_there) {
  Compared compared{"thickness", "m", {}, {}, {}, 1, 1, 2};
  const std::size_t n = 400;
  std::vector<double> simulated(n);
  for (std::size_t k = 0; k < n; ++k) {  // quantiles of a normal distribution of deviation 0.3 would do as well
    compared.surveyed.push_back(k % 2 == 0 ? 0.3 : -0.3);
    compared.places.push_back({1e3 * static_cast<double>(k), 0});
  }
  compared.error.assign(n * n, 0);
  const Likelihood likelihood(compared);
  const std::vector<double> found = likelihood.by_discrepancy({simulated, {}});
  const auto best = std::max_element(found.begin(), found.end()) - found.begin();
  EXPECT_NEAR(likelihood.table()[static_cast<std::size_t>(best)].deviation / 0.3, 1, 0.2);
}

/// A mode u adds the variance c^2 s^2 of a factor: u of the usual size, c = 1/2.
TEST(Likelihood, of_a_mode_has_the_covariance_of_a_mass_that_is_off_as_a_whole) {
  const double error = 0.04, usual = 2;
  const Likelihood likelihood({"thickness", "m", {3, 1}, {{0, 0}, {1e6, 0}}, {error, 0, 0, error}, usual, 1, 2});
  const std::vector<double> along{6, 8}, none{0, 0};  // root mean square of sqrt(50)
  const std::vector<double> found = likelihood.by_discrepancy({{2.2, 1.3}, {along, none}});
  for (std::size_t n = 0; n < found.size(); ++n) {
    const double s2 = std::pow(likelihood.table()[n].deviation, 2), unit = std::sqrt(50.0), c2 = s2 / 4;
    const double a = error + s2 + c2 * 36 / (unit * unit), b = c2 * 48 / (unit * unit),
                 d = error + s2 + c2 * 64 / (unit * unit), determinant = a * d - b * b, r = 0.8, q = -0.3;
    const double square = (d * r * r - 2 * b * r * q + a * q * q) / determinant;
    EXPECT_NEAR(found[n], -0.5 * (square + std::log(determinant)) - std::log(2 * std::numbers::pi), 1e-10);
  }
}

TEST(Likelihood, refuses_sizes_that_do_not_agree) {
  EXPECT_THROW(Likelihood({"a", "m", {1, 2}, {}, {1}, 1, 0, 0}), std::logic_error);
  EXPECT_THROW(Likelihood({"a", "m", {}, {}, {}, 1, 0, 0}), std::logic_error);
  const Likelihood likelihood({"a", "m", {1}, {}, {1}, 1, 0, 0});
  EXPECT_THROW(likelihood.by_discrepancy({{1.0, 2.0}, {}}), std::logic_error);
}

TEST(LogMean, keeps_its_digits_where_the_exponential_does_not) {
  EXPECT_NEAR(log_mean(std::vector{-2000.0, -2000.0 + std::log(3)}), -2000 + std::log(2), 1e-12);
  EXPECT_NEAR(log_mean(std::vector{2000.0}), 2000, 1e-12);
  const double never = -std::numeric_limits<double>::infinity();
  EXPECT_EQ(log_mean(std::vector{never, never}), never);
}

/// A lobe of 20 x 10 cells of 5 m on a map of 60 x 40, whose left edge was not surveyed.
struct Lobe {
  MapGrid grid{60, 40, 1000, 2000, 5, ""};
  std::vector<double> thickness = std::vector<double>(60 * 40, 0.0);
  std::vector<char> inside = std::vector<char>(60 * 40, 0);
  Lobe() {
    each_cell(grid, [&](int column, int row) {
      const std::size_t cell = grid.index(column, row);
      if (column < 3) thickness[cell] = nan;
      if (column < 20 || column >= 40 || row < 15 || row >= 25) return;
      thickness[cell] = 1 + 0.1 * column;
      inside[cell] = 1;
    });
  }
};

TEST(BlockMeans, keep_the_volume_and_part_what_lies_beyond) {
  const Lobe lobe;
  const BlockMeans blocks(lobe.grid, lobe.thickness, lobe.inside, 5, 0.1);
  EXPECT_EQ(blocks.side(), 10);
  const double whole = std::accumulate(lobe.thickness.begin(), lobe.thickness.end(), 0.0,
                                       [](double sum, double one) { return std::isnan(one) ? sum : sum + one; });
  std::vector<double> means = blocks.of(lobe.thickness);
  ASSERT_EQ(means.size(), blocks.count() + 1);
  EXPECT_EQ(means.back(), 0);
  EXPECT_NEAR(4 * std::accumulate(means.begin(), means.end(), 0.0), whole, 1e-9);  // four cells a block
  std::vector<double> farther = lobe.thickness;
  farther[lobe.grid.index(55, 5)] = 7;
  farther[lobe.grid.index(1, 5)] = 1e3;  // not surveyed
  means = blocks.of(farther);
  EXPECT_NEAR(4 * std::accumulate(means.begin(), means.end() - 1, 0.0), whole, 1e-9);
  EXPECT_NEAR(means.back(), 7 / (4.0 * static_cast<double>(blocks.count())), 1e-12);
}

TEST(BlockMeans, lie_on_no_patches_that_noise_gives) {
  Lobe lobe;
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 0.2);
  std::vector<double> noisy = lobe.thickness;
  std::vector<char> above(noisy.size());
  for (std::size_t cell = 0; cell < noisy.size(); ++cell) {
    noisy[cell] += noise(random);
    above[cell] = noisy[cell] > 0.1 ? 1 : 0;  // three cells of ten beyond the lobe
  }
  const BlockMeans blocks(lobe.grid, noisy, above, 5, 0.1), clean(lobe.grid, lobe.thickness, lobe.inside, 5, 0.1);
  EXPECT_LT(static_cast<double>(blocks.count()), 1.2 * static_cast<double>(clean.count()));
}

TEST(BlockMeans, count_beyond_what_a_survey_can_see_there) {
  const Lobe lobe;
  const BlockMeans blocks(lobe.grid, lobe.thickness, lobe.inside, 5, 0.1);
  std::vector<double> thin(lobe.grid.count(), 0.0);
  thin[lobe.grid.index(41, 20)] = 0.05;  // beside the lobe
  thin[lobe.grid.index(55, 20)] = 0.05;  // far from it
  const double cells = 4 * static_cast<double>(blocks.count());
  EXPECT_NEAR(blocks.of(thin).back(), 0.05 / cells, 1e-15);
  EXPECT_NEAR(blocks.volume_beside(thin), 0.05 / cells, 1e-15);
  thin[lobe.grid.index(55, 20)] = 0.2;
  EXPECT_NEAR(blocks.of(thin).back(), 0.25 / cells, 1e-15);
}

TEST(BlockMeans, are_no_smaller_than_the_cells_of_a_run) {
  const Lobe lobe;
  EXPECT_EQ(BlockMeans(lobe.grid, lobe.thickness, lobe.inside, 40, 0.1).side(), 40);
}

TEST(BlockMeans, have_the_covariance_of_means_of_correlated_errors) {
  const Lobe lobe;
  const BlockMeans blocks(lobe.grid, lobe.thickness, lobe.inside, 5, 0.1);
  const std::size_t n = blocks.count() + 1;
  const std::vector<double> deviation(lobe.grid.count(), 0.4);
  const std::vector<double> alone = blocks.covariance(deviation, 0), wide = blocks.covariance(deviation, 1e6),
                            some = blocks.covariance(deviation, 40);
  for (std::size_t a = 0; a + 1 < n; ++a)
    for (std::size_t b = 0; b + 1 < n; ++b) {
      EXPECT_NEAR(alone[a * n + b], a == b ? 0.16 / 4 : 0, 1e-12);
      EXPECT_NEAR(wide[a * n + b], 0.16, 1e-4);
    }
  // Two by two cells against two by two beside them: the mean over the sixteen pairs of centres, nearly.
  const auto spherical = [](double d) { return d < 40 ? 1 - 1.5 * d / 40 + 0.5 * std::pow(d / 40, 3) : 0; };
  double mean = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      mean += (2 - std::abs(i)) * (2 - std::abs(j)) * spherical(std::hypot(10 + 5 * i, 5 * j)) / 16;
  const auto places = blocks.places();
  std::size_t pairs = 0;
  for (std::size_t a = 0; a + 1 < n; ++a)
    for (std::size_t b = 0; b + 1 < n; ++b)
      if (places[b][0] - places[a][0] == 10 && places[a][1] == places[b][1]) {
        EXPECT_NEAR(some[a * n + b], 0.16 * mean, 0.003);
        ++pairs;
      }
  EXPECT_GT(pairs, 20u);
  for (std::size_t a = 0; a + 1 < n; ++a) EXPECT_EQ(some[a * n + n - 1], 0);
  const double beside = 36 * 4, inside = 60 * 4;  // cells of the ring of blocks, and of those within
  EXPECT_NEAR(alone.back(), 0.16 * beside / (inside * inside), 1e-15);
  EXPECT_NEAR(some.back(), alone.back() * std::numbers::pi / 5 * 64, 1e-12);
}

}  // namespace
}  // namespace talus::postprocess
