// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/difference.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include <Eigen/Dense>

#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/stage.hpp"

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

/// Random pairs of the cells that count.
class Sampling {
 public:
  Sampling(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& normalised)
      : patches_(patches), normalised_(normalised) {
    for (std::size_t p = 0; p < normalised.size(); ++p) {
      for (std::size_t i = 0; i < normalised[p].size(); ++i)
        if (!std::isnan(normalised[p][i])) places_.emplace_back(p, i);
    }
  }

  bool enough() const { return places_.size() >= least_pairs; }

  /// |a - b| of random pairs about `lag` cells apart.
  std::vector<double> differences(double from, double to) {
    std::vector<double> all;
    std::uniform_int_distribution<std::size_t> any(0, places_.size() - 1);
    std::uniform_real_distribution<double> part(0, 1);
    for (int tries = 0; tries < 4 * pairs_of_a_class && all.size() < pairs_of_a_class; ++tries) {
      const auto [p, i] = places_[any(random_)];
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
  std::vector<std::pair<std::size_t, std::size_t>> places_;  // patch, cell
  std::mt19937 random_{20};
};

struct Sills {
  Eigen::Vector3d value = Eigen::Vector3d::Zero();  // nugget, shorter range, longer range
  double error = INFINITY;
};

/// Non-negative least squares for nugget and sills over two ranges, trying which are 0; `allowed` has a bit for each.
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
    for (int j = 0; j < 3; ++j)
      if (subset & (1 << j)) used.push_back(j);
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

/// A second range has to explain what the first one leaves: scatter of long lags would be taken for one.
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

constexpr double class_deg = 10;
constexpr double the_same = 1e-3;            // [m] no survey of ground is as good
constexpr std::size_t least_in_class = 200;  // of a class: the NMAD of fewer is off by more than 7 %

struct Sample {
  double slope, misfit;
};

std::vector<Sample> samples_of(const std::vector<Patch>& patches, const std::vector<std::vector<double>>& misfits) {
  std::vector<Sample> samples;
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (std::size_t i = 0; i < misfits[p].size(); ++i)
      if (patches[p].unchanged[i] && !std::isnan(misfits[p][i]))
        samples.push_back({std::hypot(patches[p].slope_x[i], patches[p].slope_y[i]), misfits[p][i]});
  }
  return samples;
}

std::vector<double> misfits_in(const std::vector<Sample>& samples, double from, double to) {
  std::vector<double> all;
  for (const Sample& s : samples)
    if (s.slope >= from && s.slope < to) all.push_back(s.misfit);
  return all;
}

constexpr int block_cells = 1024;

Block block_of(const Elevation& before, const Elevation& after, const MapGrid& part, const ErrorModel& model) {
  const Raster wide = onto_grid(
      before, cut(part, {-1, -1, part.columns + 2, part.rows + 2}));  // so that blocks do not show in the slopes
  const CellWindow inner{1, 1, part.columns, part.rows};
  Block block{cut(wide, inner),
              onto_grid(after, part),
              {part, std::vector<double>(part.count())},
              cut(Raster{wide.grid, model.sigmas(wide)}, inner)};
  for (std::size_t i = 0; i < part.count(); ++i) {
    const double d = block.after.values[i] - block.before.values[i];
    block.difference.values[i] = d;
    if (std::isnan(d)) block.sigma.values[i] = d;
  }
  return block;
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

ErrorModel ErrorModel::learnt(const std::vector<Patch>& patches, const Placement& placement, double given) {
  ErrorModel model;
  std::vector<std::vector<double>> misfits;
  misfits.reserve(patches.size());
  for (const Patch& patch : patches) misfits.push_back(misfit(patch, placement));
  const std::vector<Sample> samples = samples_of(patches, misfits);
  model.given_ = given > 0;
  const auto same = [](const Sample& s) { return std::abs(s.misfit) < the_same; };
  model.same_share_ =
      samples.empty() ? 1.0
                      : static_cast<double>(std::ranges::count_if(samples, same)) / static_cast<double>(samples.size());
  model.known_ = model.given_ || model.same_share_ < 0.5;
  model.typical_ = model.given_ ? given : model.known_ ? nmad(misfits_in(samples, 0, INFINITY)) : 0;
  for (int n = 0; n * class_deg < 90 && !model.given_ && model.known_; ++n) {
    const double deg = n * class_deg;
    const auto rise = [](double angle) { return std::tan(std::min(angle, 89.9) * std::numbers::pi / 180); };
    const std::vector<double> in_class = misfits_in(samples, rise(deg), rise(deg + class_deg));
    if (in_class.size() < least_in_class) continue;
    model.slopes_.push_back(rise(deg + class_deg / 2));
    model.sigmas_.push_back(nmad(in_class));
  }
  for (std::size_t p = 0; p < patches.size(); ++p) {
    for (std::size_t i = 0; i < misfits[p].size(); ++i) {
      const double sigma = model.sigma(std::hypot(patches[p].slope_x[i], patches[p].slope_y[i]));
      misfits[p][i] = patches[p].unchanged[i] && sigma > 0 ? misfits[p][i] / sigma : nan;
    }
  }
  model.variogram_ = variogram_of(patches, misfits);
  const double cell = patches.front().before.grid.cell;
  model.offset_ =
      model.typical_ * std::sqrt(model.variogram_.of_mean(static_cast<double>(samples.size()) * cell * cell, cell));
  return model;
}

ErrorModel ErrorModel::of(double given) {
  ErrorModel model;
  model.typical_ = given;
  model.given_ = model.known_ = given > 0;
  return model;
}

double ErrorModel::sigma(double slope) const {
  if (slopes_.empty() || std::isnan(slope)) return typical_;
  const auto above = std::lower_bound(slopes_.begin(), slopes_.end(), slope);
  if (above == slopes_.begin()) return sigmas_.front();
  if (above == slopes_.end()) return sigmas_.back();
  const auto k = static_cast<std::size_t>(above - slopes_.begin());
  const double t = (slope - slopes_[k - 1]) / (slopes_[k] - slopes_[k - 1]);
  return (1 - t) * sigmas_[k - 1] + t * sigmas_[k];
}

std::vector<double> ErrorModel::sigmas(const Raster& surface) const {
  std::vector<double> values;
  for (const double cosine : slope_cosine(surface))
    values.push_back(sigma(std::sqrt(std::max(0.0, 1 / (cosine * cosine) - 1))));
  return values;
}

double ErrorModel::of_mean(double mean_square, double area, double cell) const {
  if (!known_) return nan;
  return std::sqrt(mean_square * variogram_.of_mean(area, cell) + offset_ * offset_);
}

double level_of_detection(double sigma) {
  constexpr double quantile = 1.9599639845400534;  // of the normal distribution
  return std::max(0.0, quantile * sigma);
}

void BudgetSum::add(double difference, double sigma) {
  if (difference == 0) {
    ++level_;
    level_squares_ += sigma * sigma;
    return;
  }
  Side& side = difference < 0 ? down_ : up_;
  side.sum += std::abs(difference);
  side.squares += sigma * sigma;
  ++side.cells;
}

VolumeWithError BudgetSum::volume(const Side& side, const ErrorModel& model, double cell) {
  if (side.cells == 0) return {};
  const double count = static_cast<double>(side.cells), area = count * cell * cell;
  return {side.sum * cell * cell, area, area * model.of_mean(side.squares / count, area, cell)};
}

Budget BudgetSum::budget(const ErrorModel& model, double cell) const {
  Budget budget{volume(down_, model, cell), volume(up_, model, cell), {}};
  budget.net = volume({0, down_.squares + up_.squares + level_squares_, down_.cells + up_.cells + level_}, model, cell);
  budget.net.volume = budget.deposition.volume - budget.erosion.volume;
  return budget;
}

void for_each_block(const Elevation& before, const Elevation& after, const MapGrid& grid, const ErrorModel& model,
                    const std::function<void(const Block&)>& visit) {
  for (int row = 0; row < grid.rows; row += block_cells) {
    for (int column = 0; column < grid.columns; column += block_cells) {
      stop_if_interrupted("comparing the surveys");
      const CellWindow window{column, row, std::min(block_cells, grid.columns - column),
                              std::min(block_cells, grid.rows - row)};
      visit(block_of(before, after, cut(grid, window), model));
    }
  }
}

}  // namespace talus::preprocess
