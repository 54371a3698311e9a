// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/likelihood.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace talus::postprocess {
namespace {

// The discrepancy's deviation is sought between these multiples of the usual size of what was surveyed.
constexpr double smallest_share = 0.05, largest_share = 2;
constexpr double mode_share = 0.5;  // c: size of a mode over the deviation
constexpr int deviations = 15, lengths = 6;

/// `count` values from low to high, the ratio of neighbours being the same.
std::vector<double> geometric(double low, double high, int count) {
  std::vector<double> values;
  for (int n = 0; n < count; ++n) values.push_back(low * std::pow(high / low, static_cast<double>(n) / (count - 1)));
  return values;
}

Eigen::MatrixXd correlation(const Compared& compared, double length) {
  const auto n = static_cast<Eigen::Index>(compared.surveyed.size());
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index a = 0; length > 0 && a < n; ++a)
    for (Eigen::Index b = 0; b < n; ++b) {
      const auto& [xa, ya] = compared.places[static_cast<std::size_t>(a)];
      const auto& [xb, yb] = compared.places[static_cast<std::size_t>(b)];
      matrix(a, b) = std::exp(-std::hypot(xa - xb, ya - yb) / length);
    }
  return matrix;
}

}  // namespace

struct Likelihood::Table {
  struct Entry {
    Eigen::LLT<Eigen::MatrixXd> factor;
    double constant;  ///< of the logarithm
  };
  Eigen::VectorXd surveyed;
  double scale = 0;
  std::vector<Discrepancy> values;
  std::vector<Entry> entries;
};

Likelihood::Likelihood(const Compared& compared) : table_(std::make_unique<Table>()) {
  const std::size_t n = compared.surveyed.size();
  if (n == 0 || compared.error.size() != n * n || (!compared.places.empty() && compared.places.size() != n))
    throw std::logic_error("Likelihood: sizes do not agree");
  const auto size = static_cast<Eigen::Index>(n);
  table_->surveyed = Eigen::Map<const Eigen::VectorXd>(compared.surveyed.data(), size);
  table_->scale = compared.scale;
  const Eigen::MatrixXd error = Eigen::Map<const Eigen::MatrixXd>(compared.error.data(), size, size);
  const bool placed = !compared.places.empty() && n > 1;
  for (const double length : placed ? geometric(compared.shortest, compared.longest, lengths) : std::vector{0.0}) {
    const Eigen::MatrixXd alike = correlation(compared, length);
    for (const double share : geometric(smallest_share, largest_share, deviations)) {
      const Discrepancy one{share * compared.scale, length};
      Table::Entry entry{Eigen::LLT<Eigen::MatrixXd>(error + one.deviation * one.deviation * alike), 0};
      const double log_root = entry.factor.matrixLLT().diagonal().array().log().sum();
      entry.constant = -log_root - 0.5 * static_cast<double>(n) * std::log(2 * std::numbers::pi);
      table_->values.push_back(one);
      table_->entries.push_back(std::move(entry));
    }
  }
}

Likelihood::~Likelihood() = default;
Likelihood::Likelihood(Likelihood&&) noexcept = default;

const std::vector<Discrepancy>& Likelihood::table() const { return table_->values; }

std::vector<double> Likelihood::by_discrepancy(const Simulated& simulated) const {
  const auto size = static_cast<Eigen::Index>(simulated.numbers.size());
  if (size != table_->surveyed.size()) throw std::logic_error("Likelihood: other numbers were surveyed");
  const Eigen::VectorXd residual = table_->surveyed - Eigen::Map<const Eigen::VectorXd>(simulated.numbers.data(), size);
  const auto count = static_cast<Eigen::Index>(simulated.modes.size());
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(size, count);
  for (Eigen::Index n = 0; n < count; ++n) {
    const Eigen::Map<const Eigen::VectorXd> mode(simulated.modes[static_cast<std::size_t>(n)].data(), size);
    if (mode.squaredNorm() > 0)
      modes.col(n) = mode * (table_->scale / std::sqrt(mode.squaredNorm() / static_cast<double>(size)));
  }
  std::vector<double> logarithms;
  for (std::size_t entry = 0; entry < table_->entries.size(); ++entry) {
    const auto& [factor, constant] = table_->entries[entry];
    const Eigen::VectorXd scaled = factor.matrixL().solve(residual);
    double square = scaled.squaredNorm(), log_root = 0;
    if (count > 0) {  // Woodbury's identity; modes have the usual size, and the table's deviation a share of it
      const double share = mode_share * table_->values[entry].deviation / table_->scale;
      const Eigen::MatrixXd wide = share * factor.matrixL().solve(modes);
      const Eigen::LLT<Eigen::MatrixXd> inner(Eigen::MatrixXd::Identity(count, count) + wide.transpose() * wide);
      square -= inner.matrixL().solve(wide.transpose() * scaled).squaredNorm();
      log_root = inner.matrixLLT().diagonal().array().log().sum();
    }
    logarithms.push_back(constant - log_root - 0.5 * square);
  }
  return logarithms;
}

double log_mean(std::span<const double> values) {
  const double most = values.empty() ? -std::numeric_limits<double>::infinity() : *std::ranges::max_element(values);
  if (!std::isfinite(most)) return -std::numeric_limits<double>::infinity();
  const double sum = std::accumulate(values.begin(), values.end(), 0.0,
                                     [&](double before, double value) { return before + std::exp(value - most); });
  return most + std::log(sum / static_cast<double>(values.size()));
}

}  // namespace talus::postprocess
