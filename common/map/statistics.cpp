// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/statistics.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <utility>

#include <fmt/format.h>

namespace talus {

std::string grouped(double value) { return grouped(fixed(value, 0), ","); }

std::string fixed(double value, int decimals) {
  const bool whole = value == std::round(value);
  return whole || std::abs(value) >= std::pow(10.0, 1 - decimals) ? fmt::format("{:.{}f}", value, decimals)
                                                                  : fmt::format("{:.2g}", value);
}

std::string grouped(std::string number, const char* between) {
  const std::size_t start = number.starts_with('-') ? 1 : 0;
  for (std::size_t i = std::min(number.find('.'), number.size()); i > start + 3;) number.insert(i -= 3, between);
  return number;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  const double place = q * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::ptrdiff_t>(std::floor(place));
  std::nth_element(values.begin(), values.begin() + below, values.end());
  const double low = values[static_cast<std::size_t>(below)];
  if (below + 1 == static_cast<std::ptrdiff_t>(values.size())) return low;
  const double high = *std::min_element(values.begin() + below + 1, values.end());
  return low + (place - static_cast<double>(below)) * (high - low);
}

double quantile_of_draws(const std::vector<double>& sorted, double q) {
  const auto n = static_cast<double>(sorted.size());
  const double place = std::clamp(q * (n + 1) - 1, 0.0, n - 1);
  const auto below = static_cast<std::size_t>(place), above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (place - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double p99_of_positive(const std::vector<double>& values) {
  std::vector<double> positive;
  std::copy_if(values.begin(), values.end(), std::back_inserter(positive), [](double v) { return v > 0; });
  return quantile(std::move(positive), 0.99);
}

double median(const std::vector<double>& values) { return quantile(values, 0.5); }

double median_thickness(const Raster& thickness) {
  std::vector<double> columns;
  std::copy_if(thickness.values.begin(), thickness.values.end(), std::back_inserter(columns),
               [](double t) { return t > 0; });
  std::sort(columns.begin(), columns.end());
  const double half = 0.5 * std::accumulate(columns.begin(), columns.end(), 0.0);
  double below = 0;
  for (double t : columns) {
    below += t;
    if (below >= half) return t;
  }
  return 0;
}

double nmad(const std::vector<double>& values) {
  const double middle = median(values);
  auto distances = values;
  for (double& v : distances) v = std::abs(v - middle);
  constexpr double of_a_normal_distribution = 1.4826;  // 1 / quantile of 3/4
  return of_a_normal_distribution * median(distances);
}

Spread spread_of(std::vector<double> values) {
  std::erase_if(values, [](double v) { return std::isnan(v); });
  const auto count = static_cast<double>(values.size());
  double sum = 0, square = 0;
  for (const double v : values) sum += v;
  const double mean = values.empty() ? std::numeric_limits<double>::quiet_NaN() : sum / count;
  for (const double v : values) square += (v - mean) * (v - mean);
  return {mean, std::sqrt(square / std::max(1.0, count - 1)), quantile(values, 0.05), quantile(values, 0.95)};
}

}  // namespace talus
