// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/posterior.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cctype>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/map/statistics.hpp"

namespace talus::command {
namespace {

constexpr double edge = 1.645;          // deviations of the prior, beyond which 5 % of it lie on either side
constexpr double large_loading = 0.35;  // of a key in a direction that is named

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

/// The last parts of a key that no other key shares: "friction_angle_deg", "material.friction_angle_deg".
std::string short_name(const std::string& key, const std::vector<KeySummary>& keys) {
  for (auto dot = key.rfind('.'); dot != std::string::npos && dot > 0; dot = key.rfind('.', dot - 1)) {
    const std::string end = key.substr(dot);
    if (std::ranges::count_if(keys, [&](const KeySummary& one) { return one.key.ends_with(end); }) == 1)
      return end.substr(1);
  }
  return key;
}

/// "friction_angle_deg", "higher thickness_factor with lower friction_angle_deg".
std::string direction_words(const Direction& direction, const std::vector<KeySummary>& keys) {
  std::vector<std::string> up, down;
  for (std::size_t n = 0; n < keys.size(); ++n)
    if (std::abs(direction.of_keys[n]) >= large_loading)
      (direction.of_keys[n] > 0 ? up : down).push_back(short_name(keys[n].key, keys));
  if (up.empty()) std::swap(up, down);
  if (up.size() + down.size() == 1) return up.front();
  if (down.empty()) return fmt::format("higher {} together", fmt::join(up, " and "));
  return fmt::format("higher {} with lower {}", fmt::join(up, " and "), fmt::join(down, " and "));
}

/// "0.7 m", "0.34".
std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.2g}{}", value, unit == "1" ? "" : " " + unit);
}

std::string capital(std::string words) {
  words.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(words.front())));
  return words;
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
    return fmt::format(" {:7.4g} {:7.4g} {:7.4g}", of.low, of.median, of.high);
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
      said.push_back(fmt::format("The survey does not determine {}: {} of the prior deviation is left.",
                                 direction_words(direction, summary.keys), percent(std::min(1.0, direction.left))));
  for (const KeySummary& key : summary.keys)
    if (std::abs(key.shift) > edge)
      said.push_back(
          fmt::format("{} lies in the {} 5 % of its prior distribution: the true value may lie beyond. Widen "
                      "[[ensemble.vary]] and calibrate again.",
                      short_name(key.key, summary.keys), key.shift > 0 ? "upper" : "lower"));
  for (const DiscrepancySummary& one : summary.discrepancies) {
    const std::string length = one.length > 0 ? fmt::format(" over {:.0f} m", one.length) : "";
    const std::string beside =
        one.survey_error > 0
            ? fmt::format("{} than the survey's error of {}", one.deviation > one.survey_error ? "larger" : "smaller",
                          with_unit(one.survey_error, one.unit))
            : "including the survey's error, which is not known";
    said.push_back(fmt::format("{}: the model's discrepancy is {}{}, {}.", capital(one.name),
                               with_unit(one.deviation, one.unit), length, beside));
    if (one.at_most > 0.5)
      said.push_back(
          fmt::format("{}: no run comes near the survey. The intervals hold for a model that does not describe this "
                      "event: check release, terrain and law.",
                      capital(one.name)));
    if (one.at_least > 0.5)
      said.push_back(
          fmt::format("{}: no discrepancy is found. Of a measured survey this is rare: check whether its stated error "
                      "is too large.",
                      capital(one.name)));
  }
  said.push_back(
      fmt::format("Logarithm of the evidence: {:.1f}, standard error {:.1f} or more. Of two recipes with the same "
                  "survey, the one with the larger evidence explains it better; a difference of 3 is strong (Kass and "
                  "Raftery 1995).",
                  summary.log_evidence, summary.log_evidence_error));
  return said;
}

}  // namespace talus::command
