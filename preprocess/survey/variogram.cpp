// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/variogram.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "common/map/statistics.hpp"

namespace talus::preprocess {

namespace {

constexpr int classes = 15;
constexpr int pairs_of_a_class = 4000;
constexpr std::size_t least_pairs = 200;

double spherical(double lag, double range) {
  const double h = lag / range;
  return h < 1 ? 1 - 1.5 * h + 0.5 * h * h * h : 0;
}

/// The spherical model integrated over a disc of radius `radius`, over its area.
double over_disc(double range, double radius) {
  const double m = std::min(range, radius);
  return 2 / (radius * radius) * (m * m / 2 - m * m * m / (2 * range) + std::pow(m, 5) / (10 * std::pow(range, 3)));
}

/// Places of the cells that count.
struct Cells {
  std::vector<std::pair<std::size_t, std::size_t>> places;  // patch, cell
};

Cells cells_of(const std::vector<std::vector<double>>& normalised) {
  Cells cells;
  for (std::size_t p = 0; p < normalised.size(); ++p) {
    for (std::size_t i = 0; i < normalised[p].size(); ++i) {
      if (!std::isnan(normalised[p][i])) cells.places.emplace_back(p, i);
    }
  }
  return cells;
}

class Sampling {
 public:
  Sampling(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& normalised)
      : patches_(patches), normalised_(normalised), cells_(cells_of(normalised)) {}

  bool enough() const { return cells_.places.size() >= least_pairs; }

  /// |a - b| of random pairs about `lag` cells apart.
  std::vector<double> differences(double from, double to) {
    std::vector<double> all;
    std::uniform_int_distribution<std::size_t> any(0, cells_.places.size() - 1);
    std::uniform_real_distribution<double> part(0, 1);
    for (int tries = 0; tries < 4 * pairs_of_a_class && all.size() < pairs_of_a_class; ++tries) {
      const auto [p, i] = cells_.places[any(random_)];
      const MapGrid& grid = patches_[p].before.grid;
      const double lag = from + (to - from) * part(random_), angle = 2 * std::numbers::pi * part(random_);
      auto [column, row] = grid.cell_of(i);
      column += static_cast<int>(std::lround(lag * std::cos(angle)));
      row += static_cast<int>(std::lround(lag * std::sin(angle)));
      if (!grid.holds(column, row)) continue;
      const std::size_t j = grid.index(column, row);
      if (j == i || std::isnan(normalised_[p][j])) continue;
      all.push_back(std::abs(normalised_[p][i] - normalised_[p][j]));
    }
    return all;
  }

 private:
  const std::vector<Patch>& patches_;
  const std::vector<std::vector<double>>& normalised_;
  Cells cells_;
  std::mt19937 random_{20};
};

/// Non-negative least squares for nugget and two sills, by trying which of them are zero.
struct Sills {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  // nugget, shorter range, longer range
  double error = INFINITY;
};

/// Non-negative least squares for nugget and sills over two ranges, by trying which of them are zero; `allowed` has a
/// bit for each that may be used.
Sills best_sills(const Variogram& v, double short_range, double long_range, int allowed) {
  const auto n = static_cast<Eigen::Index>(v.lags.size());
  Eigen::MatrixXd all(n, 3);
  Eigen::VectorXd wanted(n);
  for (Eigen::Index k = 0; k < n; ++k) {
    const double lag = v.lags[static_cast<std::size_t>(k)];
    all.row(k) << 1, 1 - spherical(lag, short_range), 1 - spherical(lag, long_range);
    wanted[k] = v.semivariance[static_cast<std::size_t>(k)];
  }
  Sills best;
  for (int subset = 1; subset < 8; ++subset) {
    if ((subset & allowed) != subset) continue;
    std::vector<Eigen::Index> used;
    for (int j = 0; j < 3; ++j) {
      if (subset & (1 << j)) used.push_back(j);
    }
    const Eigen::MatrixXd some = all(Eigen::all, used);
    const Eigen::VectorXd value = some.colPivHouseholderQr().solve(wanted);
    const double error = (some * value - wanted).squaredNorm();
    if (value.minCoeff() < 0 || !(error < best.error)) continue;
    best.error = error;
    best.value.setZero();
    for (std::size_t j = 0; j < used.size(); ++j) best.value[used[j]] = value[static_cast<Eigen::Index>(j)];
  }
  return best;
}

/// A second range has to explain what the first one leaves: semivariances of long lags scatter, and would be taken for
/// one.
constexpr double worth_a_range = 0.5;

void fit_model(Variogram& v) {
  Sills best;
  for (const double range : v.lags) {
    const Sills one = best_sills(v, range, range, 0b011);
    if (!(one.error < best.error)) continue;
    best = one;
    v.short_range = range;
  }
  const double enough = worth_a_range * best.error;
  Sills two{best.value, enough};
  for (std::size_t a = 0; a < v.lags.size(); ++a) {
    for (std::size_t b = a + 1; b < v.lags.size(); ++b) {
      const Sills sills = best_sills(v, v.lags[a], v.lags[b], 0b111);
      if (!(sills.error < two.error)) continue;
      two = sills;
      v.short_range = v.lags[a];
      v.long_range = v.lags[b];
    }
  }
  if (two.error < enough) best = two;
  const double sum = best.value.sum();
  if (!(sum > 0)) return;
  v.nugget = best.value[0] / sum;
  v.short_sill = best.value[1] / sum;
  v.long_sill = best.value[2] / sum;
}

}  // namespace

double Variogram::correlation(double lag) const {
  if (lag <= 0) return 1;
  return (short_sill > 0 ? short_sill * spherical(lag, short_range) : 0) +
         (long_sill > 0 ? long_sill * spherical(lag, long_range) : 0);
}

double Variogram::of_mean(double area, double cell) const {
  if (!(area > cell * cell)) return 1;
  const double radius = std::sqrt(area / std::numbers::pi);
  double variance = nugget * cell * cell / area;
  if (short_sill > 0) variance += short_sill * over_disc(short_range, radius);
  if (long_sill > 0) variance += long_sill * over_disc(long_range, radius);
  return std::min(1.0, variance);
}

double Variogram::equivalent_range(double area, double cell) const {
  const double wanted = of_mean(area, cell), radius = std::sqrt(area / std::numbers::pi);
  double low = 0, high = 100 * radius;
  for (int i = 0; i < 100; ++i) {
    const double middle = (low + high) / 2;
    (over_disc(middle, radius) < wanted ? low : high) = middle;
  }
  return low > 1.5 * cell ? low : 0;
}

Variogram variogram_of(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& normalised) {
  Variogram v;
  Sampling sampling(patches, normalised);
  if (!sampling.enough()) return v;
  const MapGrid& grid = patches.front().before.grid;
  const double farthest = 0.5 * std::min(grid.columns, grid.rows);
  double from = 0.75;
  for (int k = 0; k < classes; ++k) {
    const double to = 0.75 * std::pow(farthest / 0.75, (k + 1.0) / classes);
    const std::vector<double> differences = sampling.differences(from, to);
    if (differences.size() >= least_pairs) {
      const double middle = median(differences);
      v.lags.push_back(std::max(1.0, (from + to) / 2) * grid.cell);
      v.semivariance.push_back(2.198 * middle * middle / 2);
    }
    from = to;
  }
  if (v.lags.size() >= 4) fit_model(v);
  return v;
}

}  // namespace talus::preprocess
