// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/posterior.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/map/statistics.hpp"

namespace talus::command {
namespace {

constexpr double edge = 2;              // deviations of the prior: what lies beyond is at its edge
constexpr double large_loading = 0.35;  // of a key in a direction that is named

/// The value below which a further draw lies with a probability `q` (Hyndman and Fan 1996, type 6).
double quantile_of_draws(const std::vector<double>& sorted, double q) {
  const auto n = static_cast<double>(sorted.size());
  const double place = std::clamp(q * (n + 1) - 1, 0.0, n - 1);
  const auto below = static_cast<std::size_t>(place), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

Quantiles quantiles_of(std::vector<double> values) {
  std::ranges::sort(values);
  return {quantile_of_draws(values, 0.05), quantile_of_draws(values, 0.5), quantile_of_draws(values, 0.95)};
}

Eigen::MatrixXd matrix_of(const Places& places) {
  Eigen::MatrixXd matrix(static_cast<Eigen::Index>(places.size()), static_cast<Eigen::Index>(places.front().size()));
  for (Eigen::Index k = 0; k < matrix.rows(); ++k)
    for (Eigen::Index n = 0; n < matrix.cols(); ++n)
      matrix(k, n) = places[static_cast<std::size_t>(k)][static_cast<std::size_t>(n)];
  return matrix;
}

/// The effective number of independent draws falls at each step; the variance of its log mean is about 1/n_eff - 1/n.
double evidence_error(const Posterior& draws) {
  double variance = 0;
  const auto n = static_cast<double>(draws.places.size());
  for (const TemperingStep& step : draws.steps) variance += 1 / step.effective - 1 / n;
  return std::sqrt(std::max(0.0, variance));
}

std::string short_name(const std::string& key) {
  const auto dot = key.rfind('.');
  return dot == std::string::npos ? key : key.substr(dot + 1);
}

/// "friction_angle_deg and thickness_factor, the one higher and the other lower".
std::string direction_words(const Direction& direction, const std::vector<KeySummary>& keys) {
  std::vector<std::string> up, down;
  for (std::size_t n = 0; n < keys.size(); ++n)
    if (std::abs(direction.of_keys[n]) >= large_loading)
      (direction.of_keys[n] > 0 ? up : down).push_back(short_name(keys[n].key));
  if (up.empty()) std::swap(up, down);
  if (down.empty()) return fmt::format("{}", fmt::join(up, " and "));
  return fmt::format("more {} with less {}", fmt::join(up, " and "), fmt::join(down, " and "));
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100 * share); }

}  // namespace

PosteriorSummary summary_of(const Posterior& draws, const MemberTable& prior, const MemberTable& posterior) {
  PosteriorSummary summary;
  summary.log_evidence = draws.log_evidence;
  summary.log_evidence_error = evidence_error(draws);
  const Eigen::MatrixXd places = matrix_of(draws.places);
  const Eigen::MatrixXd apart = places.rowwise() - places.colwise().mean();
  const Eigen::MatrixXd covariance =
      apart.transpose() * apart / static_cast<double>(std::max<Eigen::Index>(1, places.rows() - 1));
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    const MemberColumn& before = prior.columns[static_cast<std::size_t>(n)];
    const MemberColumn& after = posterior.columns[static_cast<std::size_t>(n)];
    KeySummary key{before.key, {}, {}, std::sqrt(covariance(n, n)), 0};
    if (before.words.empty()) {
      key.prior = quantiles_of(before.values);
      key.posterior = quantiles_of(after.values);
    }
    const Eigen::VectorXd column = places.col(n);
    key.shift = median({column.begin(), column.end()});
    summary.keys.push_back(std::move(key));
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> axes(covariance);
  for (Eigen::Index n = 0; n < places.cols(); ++n) {
    const Eigen::VectorXd axis = axes.eigenvectors().col(n);
    summary.directions.push_back({{axis.begin(), axis.end()}, std::sqrt(std::max(0.0, axes.eigenvalues()[n]))});
  }
  return summary;
}

std::vector<std::string> table_lines(const PosteriorSummary& summary) {
  std::size_t width = 0;
  for (const KeySummary& key : summary.keys) width = std::max(width, key.key.size());
  std::vector<std::string> lines{
      fmt::format("{:{}}  {:>24}  {:>24}  {:>5}", "", width, "before: 5, 50, 95 %", "after: 5, 50, 95 %", "left")};
  const auto three = [](const Quantiles& of) {
    return fmt::format("{:8.4g}{:8.4g}{:8.4g}", of.low, of.median, of.high);
  };
  for (const KeySummary& key : summary.keys)
    lines.push_back(fmt::format("{:{}}  {:>24}  {:>24}  {:>5}", key.key, width, three(key.prior), three(key.posterior),
                                percent(key.left)));
  return lines;
}

std::vector<std::string> conclusions(const PosteriorSummary& summary) {
  std::vector<std::string> said;
  for (const Direction& direction : summary.directions)
    if (direction.left > not_told)
      said.push_back(fmt::format("The survey does not tell {}: {} of the doubt before it is left",
                                 direction_words(direction, summary.keys), percent(std::min(1.0, direction.left))));
  for (const KeySummary& key : summary.keys)
    if (std::abs(key.shift) > edge)
      said.push_back(
          fmt::format("{} lies in the {} 5 % of its distribution in [[ensemble.vary]]: the truth may lie beyond. "
                      "Widen it and calibrate again",
                      short_name(key.key), key.shift > 0 ? "upper" : "lower"));
  for (const DiscrepancySummary& one : summary.discrepancies) {
    const std::string length = one.length > 0 ? fmt::format(", alike over {:.0f} m", one.length) : "";
    const std::string beside =
        one.survey_error > 0 ? fmt::format("{} the survey's error of {:.2g} {}",
                                           one.deviation > one.survey_error ? "it dominates" : "it is smaller than",
                                           one.survey_error, one.unit)
                             : "the survey's error is not known, and is part of it";
    said.push_back(
        fmt::format("{}: the model is off by {:.2g} {}{}; {}", one.name, one.deviation, one.unit, length, beside));
    if (one.at_most > 0.5)
      said.push_back(
          fmt::format("{}: no run comes near the survey. The intervals are of a model that does not describe "
                      "this event: look at release, terrain and law",
                      one.name));
    if (one.at_least > 0.5)
      said.push_back(
          fmt::format("{}: runs agree with the survey as well as can be told. If it is not a computed one, "
                      "its error is larger than given",
                      one.name));
  }
  said.push_back(
      fmt::format("Logarithm of the evidence: {:.1f}, standard error {:.1f} or more. Of recipes with the same survey "
                  "that with the larger one explains it better; a difference of 3 is strong (Kass and Raftery 1995)",
                  summary.log_evidence, summary.log_evidence_error));
  return said;
}

}  // namespace talus::command
