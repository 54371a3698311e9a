// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/wave_fit.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "common/map/fourier.hpp"
#include "common/map/statistics.hpp"
#include "preprocess/survey/shift_fit.hpp"

namespace talus::preprocess {
namespace {

constexpr double quietest = 1e-3;   // noise of a band over that of the noisiest, at least: a fading rim leaks as much
constexpr double rounding = 1e-12;  // noise in squared cells of shift: of two surveys that are the same
constexpr int most_passes = 10;
constexpr double settled = 1e-6;  // cells

/// Power of the misfit a wave, of that which `shift` does not explain.
std::vector<double> noise_of(const std::vector<WaveBand>& bands, double share, const Eigen::Vector2d& shift) {
  std::vector<double> noise;
  for (const WaveBand& b : bands) {
    const double left = b.misfit - 2 * shift.dot(b.pull) + shift.dot(b.slope * shift);
    noise.push_back(b.waves > 0 ? (std::max(left, 0.0) + rounding * b.slope.trace()) / b.waves / share : 0.0);
  }
  return noise;
}

/// The weights of least error. Noise differs from wave to wave, what is folded is one error for all: the inverse of a
/// diagonal and a product of one vector with itself (Sherman & Morrison 1950).
std::vector<double> weights_of(const std::vector<WaveBand>& bands, const std::vector<double>& noise, double phase) {
  const double floor = quietest * *std::max_element(noise.begin(), noise.end());
  double both = 0, squares = 0;
  std::vector<double> variance;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    variance.push_back(bands[k].slope.trace() * (noise[k] + floor));
    if (!(variance[k] > 0)) continue;
    const double terrain = bands[k].terrain(), folded = terrain * bands[k].folded.sum();
    both += folded * terrain * bands[k].slope.trace() / variance[k];
    squares += folded * folded / variance[k];
  }
  const double taken = phase * phase * both / (1 + phase * phase * squares);
  std::vector<double> weight;
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const double terrain = bands[k].terrain();
    const double told = terrain * (bands[k].slope.trace() - taken * bands[k].folded.sum());
    weight.push_back(variance[k] > 0 ? std::max(0.0, told / variance[k]) : 0.0);
  }
  return weight;
}

/// One solution with the weights that belong to a shift.
BandFit solved(const std::vector<WaveBand>& bands, const std::vector<double>& noise, const Eigen::Vector2d& phase) {
  BandFit fit;
  fit.weight = weights_of(bands, noise, phase.norm() / std::numbers::sqrt2);
  Eigen::Matrix2d response = Eigen::Matrix2d::Zero(), variance = Eigen::Matrix2d::Zero();
  Eigen::Vector2d pull = Eigen::Vector2d::Zero(), folded = Eigen::Vector2d::Zero();
  for (std::size_t k = 0; k < bands.size(); ++k) {
    const double w = fit.weight[k];
    response += w * bands[k].shared;
    pull += w * bands[k].pull;
    variance += w * w * noise[k] * bands[k].slope;
    folded += w * bands[k].terrain() * bands[k].folded.cwiseProduct(phase.cwiseAbs());
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(response);
  fit.known = axes.eigenvalues()[0] > 1e-9 * axes.eigenvalues()[1] && axes.eigenvalues()[0] > 0;
  if (!fit.known) return fit;
  fit.inverse_response = response.inverse();
  fit.shift = fit.inverse_response * pull;
  fit.covariance = fit.inverse_response * variance * fit.inverse_response;
  fit.folded = (fit.inverse_response * folded).cwiseAbs();
  return fit;
}

constexpr int tiles = 8;  // along each side of the map

using Wave = std::complex<double>;

/// Slopes along x and y from the cells beside [m a cell].
std::array<std::vector<double>, 2> slopes_between(const MapGrid& grid, const std::vector<double>& z) {
  std::array<std::vector<double>, 2> slopes;
  slopes.fill(std::vector<double>(z.size(), nan));
  const auto columns = static_cast<std::size_t>(grid.columns);
  for (int row = 1; row + 1 < grid.rows; ++row) {
    for (int column = 1; column + 1 < grid.columns; ++column) {
      const std::size_t i = grid.index(column, row);
      slopes[0][i] = (z[i + 1] - z[i - 1]) / 2;
      slopes[1][i] = (z[i + columns] - z[i - columns]) / 2;
    }
  }
  return slopes;
}

/// The two fields of a plane that was transformed as first + i second, at wave i; `mirrored` is the place of -i.
std::array<Wave, 2> both_of(const Waves& waves, std::size_t i, std::size_t mirrored) {
  const Wave a = waves[i], b = std::conj(waves[mirrored]);
  return {0.5 * (a + b), Wave(0, -0.5) * (a - b)};
}

double product(Wave a, Wave b) { return a.real() * b.real() + a.imag() * b.imag(); }

}  // namespace

double WaveBand::terrain() const {
  const double all = slope.trace();
  return all > 0 ? std::clamp(shared.trace() / all, 0.0, 1.0) : 0.0;
}

BandFit fit_bands(const std::vector<WaveBand>& bands, double share, const Eigen::Vector2d& phase) {
  BandFit fit = solved(bands, noise_of(bands, share, Eigen::Vector2d::Zero()), phase);
  for (int pass = 0; pass < most_passes && fit.known; ++pass) {
    const Eigen::Vector2d before = fit.shift;
    fit = solved(bands, noise_of(bands, share, before), phase);
    if ((fit.shift - before).norm() < settled) break;
  }
  return fit;
}

double fall_of_terrain(const std::vector<WaveBand>& bands) {
  constexpr double unknown = 3, least = 2, most = 8, hidden = 0.1;
  double weights = 0, x = 0, y = 0, xx = 0, xy = 0;
  int count = 0;
  for (const WaveBand& b : bands) {
    const double number = b.waves > 0 ? b.number / b.waves : 0;
    if (number < std::numbers::pi / 6 || number > std::numbers::pi / 2 || b.terrain() < hidden) continue;
    const double at = std::log(number), power = std::log(b.shared.trace() / b.waves / (number * number));
    const double w = b.waves * b.terrain();
    weights += w, x += w * at, y += w * power, xx += w * at * at, xy += w * at * power;
    ++count;
  }
  if (count < 2) return unknown;
  return std::clamp(-(xy - x * y / weights) / (xx - x * x / weights), least, most);
}

WaveFit::WaveFit(const std::vector<Patch>& patches, const Placement& placement) : patches_(patches) {
  const std::vector<double> all = stable_misfit(patches, placement);
  const double centre = median(all), limit = biweight_cut * nmad(all);
  for (std::size_t p = 0; p < patches.size(); ++p) {
    from_.push_back(p);
    add_patch(patches[p], placement, centre, limit);
    if (slopes_.size() < from_.size()) from_.pop_back();
  }
  if (!slopes_.empty()) add_folded();
  share_ /= std::max<double>(1, static_cast<double>(windows_.size()));
}

template <class Visit>
void WaveFit::each_wave(const Visit& visit) const {
  const int wide = windows_.front().wide(), high = windows_.front().high();
  for (int row = 0; row < high; ++row) {
    const auto line = static_cast<std::size_t>(row) * static_cast<std::size_t>(wide);
    const auto mirrored_line = static_cast<std::size_t>((high - row) % high) * static_cast<std::size_t>(wide);
    for (int column = row == 0 ? 1 : 0; column < wide; ++column)
      visit(line + static_cast<std::size_t>(column), mirrored_line + static_cast<std::size_t>((wide - column) % wide),
            column, row);
  }
}

/// Half octaves; in one the waves longer than a quarter of the map, some fifty (the noise of fewer could not be told),
/// and in one the corners beyond the wave of two cells.
void WaveFit::number_bands(int wide, int high) {
  constexpr int first = 3;  // half octaves: longer than side / 4
  const double side = std::max(wide, high);
  const auto half_octave = [](double numbers) { return static_cast<int>(std::floor(2 * std::log2(numbers))); };
  const int last = std::max(first, half_octave(0.6 * side));
  bands_.resize(static_cast<std::size_t>(last - first + 1));
  band_.resize(static_cast<std::size_t>(wide) * static_cast<std::size_t>(high));
  each_wave([&](std::size_t i, std::size_t, int column, int row) {
    const double k = std::hypot(number(column, wide), number(row, high));
    band_[i] = static_cast<unsigned char>(std::clamp(half_octave(k * side), first, last) - first);
  });
}

void WaveFit::add_patch(const Patch& patch, const Placement& placement, double centre, double limit) {
  const MapGrid& grid = patch.before.grid;
  const std::vector<double> d = misfit(patch, placement);
  const auto slopes = slopes_between(grid, patch.before.values), of_misfit = slopes_between(grid, d);
  std::array<std::vector<double>, 2> later = slopes;
  std::vector<char> used(d.size());
  for (std::size_t i = 0; i < d.size(); ++i) {
    for (std::size_t axis = 0; axis < 2; ++axis) later[axis][i] += of_misfit[axis][i];
    used[i] = patch.unchanged[i] && patch.gentle[i] && std::abs(d[i] - centre) <= limit && std::isfinite(later[0][i]) &&
              std::isfinite(later[1][i]);
  }
  PatchWindow window(grid, used);
  if (!window.enough()) return;
  windows_.push_back(std::move(window));
  const PatchWindow& w = windows_.back();
  if (band_.empty()) number_bands(w.wide(), w.high());
  slopes_.push_back(w.waves(slopes[0], slopes[1]));
  const Waves with = w.waves(later[0], later[1]);
  each_wave([&](std::size_t i, std::size_t mirrored, int column, int row) {
    const auto g = both_of(slopes_.back(), i, mirrored), h = both_of(with, i, mirrored);
    WaveBand& band = bands_[band_[i]];
    band.waves += 1;
    band.number += 2 * std::numbers::pi * std::hypot(number(column, w.wide()), number(row, w.high()));
    const double across = product(g[0], g[1]), shared = (product(g[0], h[1]) + product(g[1], h[0])) / 2;
    band.slope += Eigen::Matrix2d{{product(g[0], g[0]), across}, {across, product(g[1], g[1])}};
    band.shared += Eigen::Matrix2d{{product(g[0], h[0]), shared}, {shared, product(g[1], h[1])}};
  });
  share_ += w.share();
  used_.push_back(std::move(used));
}

/// The wave k shows what stands in k - 1 (in waves a cell), whose phase turns the other way when the posts move: for
/// terrain that falls as k^-n, so much of its power pulls towards whole cells.
void WaveFit::add_folded() {
  const double half = fall_of_terrain(bands_) / 2;
  const int wide = windows_.front().wide(), high = windows_.front().high();
  constexpr double longest = 1.0 / 16;  // of which less than a thousandth is folded
  each_wave([&](std::size_t i, std::size_t mirrored, int column, int row) {
    const double x = std::abs(number(column, wide)), y = std::abs(number(row, high)), square = x * x + y * y;
    if (square < longest * longest) return;
    const double in_x = std::pow(((1 - x) * (1 - x) + y * y) / square, -half),
                 in_y = std::pow((x * x + (1 - y) * (1 - y)) / square, -half), sum = 1 + in_x + in_y;
    const auto over_sine = [](double part, double k) {
      return part / std::max(1e-3, std::sin(2 * std::numbers::pi * k));
    };
    for (const Waves& waves : slopes_) {
      const auto g = both_of(waves, i, mirrored);
      bands_[band_[i]].folded +=
          Eigen::Vector2d(std::norm(g[0]) * over_sine(in_x / sum, x), std::norm(g[1]) * over_sine(in_y / sum, y));
    }
  });
}

bool WaveFit::measure(const Placement& placement) {
  misfits_.clear();
  for (WaveBand& band : bands_) band.pull.setZero(), band.misfit = 0;
  for (std::size_t p = 0; p < from_.size(); ++p) {
    const std::vector<double> d = misfit(patches_[from_[p]], placement);
    for (std::size_t i = 0; i < d.size(); ++i)
      if (used_[p][i] && std::isnan(d[i])) return false;
    misfits_.push_back(windows_[p].waves(d, {}));
    each_wave([&](std::size_t i, std::size_t mirrored, int, int) {
      const auto g = both_of(slopes_[p], i, mirrored);
      const Wave misfit = misfits_.back()[i];
      bands_[band_[i]].pull += Eigen::Vector2d(product(g[0], misfit), product(g[1], misfit));
      bands_[band_[i]].misfit += std::norm(misfit);
    });
  }
  return true;
}

Eigen::Vector2d WaveFit::spread(const BandFit& fit) const {
  const int side = patches_.size() == 1 ? tiles : 1;
  std::vector<Eigen::Vector2d> told;
  for (std::size_t p = 0; p < from_.size(); ++p) {
    const PatchWindow& w = windows_[p];
    Waves slope = slopes_[p], misfit = misfits_[p];
    slope[0] = misfit[0] = 0;
    each_wave([&](std::size_t i, std::size_t, int, int) {
      const double root = std::sqrt(fit.weight[band_[i]]);
      slope[i] *= root, misfit[i] *= root;
    });
    inverse_fourier_transform(slope, w.wide(), w.high());
    inverse_fourier_transform(misfit, w.wide(), w.high());
    const std::size_t first = told.size();
    told.resize(first + static_cast<std::size_t>(side) * static_cast<std::size_t>(side), Eigen::Vector2d::Zero());
    for (int row = 0; row < w.rows(); ++row) {
      for (int column = 0; column < w.columns(); ++column) {
        const auto i =
            static_cast<std::size_t>(row) * static_cast<std::size_t>(w.wide()) + static_cast<std::size_t>(column);
        const auto tile = static_cast<std::size_t>(row * side / w.rows() * side + column * side / w.columns());
        told[first + tile] += misfit[i].real() * Eigen::Vector2d(slope[i].real(), slope[i].imag());
      }
    }
  }
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  const double count = static_cast<double>(told.size());
  for (const Eigen::Vector2d& t : told) mean += t / count;
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  for (const Eigen::Vector2d& t : told) sum += (t - mean) * (t - mean).transpose();
  const double scale = static_cast<double>(band_.size());  // Parseval: a sum over waves is so many over cells
  const Eigen::Matrix2d variance =
      fit.inverse_response * sum * fit.inverse_response * (scale * scale * count / std::max(1.0, count - 1));
  return variance.diagonal();
}

}  // namespace talus::preprocess
