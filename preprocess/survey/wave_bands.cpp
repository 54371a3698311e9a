// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/wave_bands.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace talus::preprocess
