// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/score/contingency.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "common/gis/resampling.hpp"
#include "common/map/statistics.hpp"

namespace talus::postprocess {
namespace {

double ratio(double part, double whole) { return whole > 0 ? part / whole : nan; }

/// 1 where two sizes agree, falling steeply as their ratio leaves 1.
double likeness(double ratio) {
  return ratio > 0 ? std::pow(std::sin(std::numbers::pi / 2 * std::min(ratio, 1 / ratio)), 5) : 0;
}

double thickness_or_none(double value) { return std::isfinite(value) ? value : 0; }

}  // namespace

double Contingency::csi() const { return ratio(true_positive, true_positive + false_positive + false_negative); }
double Contingency::hit_rate() const { return ratio(true_positive, true_positive + false_negative); }
double Contingency::false_alarm_ratio() const { return ratio(false_positive, true_positive + false_positive); }
double Contingency::foc() const { return ratio(true_positive + false_positive, true_positive + false_negative); }

double Contingency::hss() const {
  const double tp = true_positive, fp = false_positive, fn = false_negative, tn = true_negative;
  return ratio(2 * (tp * tn - fp * fn), (tp + fn) * (fn + tn) + (tp + fp) * (fp + tn));
}

double Contingency::d2pc() const {
  return std::hypot(1 - hit_rate(), ratio(false_positive, false_positive + true_negative));
}

double Contingency::spi(double runout_ratio) const {
  if (!(runout_ratio > 0)) return nan;
  Contingency even = *this;
  even.true_negative = std::max(0.0, 5 * (true_positive + false_negative) - false_positive);
  const double sum = std::max(0.0, csi()) + std::max(0.0, even.hss()) + std::max(0.0, 1 - even.d2pc()) +
                     likeness(foc()) + likeness(runout_ratio);
  return true_positive + false_negative > 0 ? sum / 5 : nan;
}

Contingency compare(const std::vector<double>& simulated, double simulated_threshold,
                    const std::vector<double>& surveyed, double surveyed_threshold, double cell_area) {
  Contingency areas;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    if (std::isnan(simulated[i]) || std::isnan(surveyed[i])) continue;
    const bool here = simulated[i] > simulated_threshold, there = surveyed[i] > surveyed_threshold;
    double& area = here ? (there ? areas.true_positive : areas.false_positive)
                        : (there ? areas.false_negative : areas.true_negative);
    area += cell_area;
  }
  return areas;
}

double brier_score(const std::vector<double>& share, const std::vector<double>& surveyed, double threshold) {
  double squares = 0, cells = 0;
  for (std::size_t i = 0; i < share.size(); ++i) {
    const double there = surveyed[i] > threshold ? 1 : 0;
    if (std::isnan(share[i]) || std::isnan(surveyed[i]) || (share[i] == 0 && there == 0)) continue;
    squares += (share[i] - there) * (share[i] - there);
    ++cells;
  }
  return ratio(squares, cells);
}

ThicknessError thickness_error(const std::vector<double>& simulated, const std::vector<double>& surveyed,
                               double threshold) {
  std::vector<double> differences;
  double square = 0, sum = 0, absolute = 0;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    // NaN in either makes both comparisons or the difference fail: not surveyed, not counted.
    const double difference = simulated[i] - surveyed[i];
    if (std::isnan(difference) || !(simulated[i] > threshold || surveyed[i] > threshold)) continue;
    square += difference * difference;
    sum += difference;
    absolute += std::abs(difference);
    differences.push_back(difference);
  }
  const auto count = static_cast<double>(differences.size());
  return {std::sqrt(ratio(square, count)), ratio(sum, count), ratio(absolute, count), median(differences),
          nmad(differences)};
}

double auroc(const std::vector<double>& simulated, const std::vector<double>& surveyed, double threshold) {
  std::vector<std::pair<double, bool>> cells;
  for (std::size_t i = 0; i < simulated.size(); ++i)
    if (!std::isnan(simulated[i]) && !std::isnan(surveyed[i]))
      cells.emplace_back(simulated[i], surveyed[i] > threshold);
  std::sort(cells.begin(), cells.end());
  double wins = 0, yes = 0, no = 0;
  for (std::size_t start = 0; start < cells.size();) {
    double yes_here = 0, no_here = 0;  // of one value
    std::size_t end = start;
    for (; end < cells.size() && cells[end].first == cells[start].first; ++end)
      (cells[end].second ? yes_here : no_here) += 1;
    wins += yes_here * (no + 0.5 * no_here);
    yes += yes_here;
    no += no_here;
    start = end;
  }
  return yes > 0 && no > 0 ? wins / (yes * no) : nan;
}

Residual residual_of(const std::vector<double>& simulated, const std::vector<double>& surveyed,
                     const std::vector<double>& sigma, const std::vector<char>& counts) {
  constexpr double normal_95 = 1.96;
  std::vector<double> residuals;
  double within = 0, square = 0;
  for (std::size_t i = 0; i < simulated.size(); ++i) {
    const double r = (simulated[i] - surveyed[i]) / sigma[i];
    if (!counts[i] || !(sigma[i] > 0) || std::isnan(r)) continue;
    residuals.push_back(r);
    within += std::abs(r) <= normal_95 ? 1 : 0;
    square += r * r;
  }
  if (residuals.empty()) return {0, nan, nan, nan};
  const auto count = static_cast<double>(residuals.size());
  return {residuals.size(), median(residuals), within / count, square / count};
}

DepositDifference deposit_difference(const RunMaps& first, const RunMaps& second, double threshold) {
  const Raster theirs_as_is{second.grid, second.deposit_thickness};
  const bool same = first.grid.has_cells_of(second.grid) && first.grid.crs_wkt == second.grid.crs_wkt;
  const Raster other = same ? theirs_as_is : resample_thickness(theirs_as_is, first.grid);
  DepositDifference found{.difference = {first.grid, std::vector<double>(first.grid.count(), nan)}};
  Sum ours, theirs, squares;
  std::vector<double> changes;
  std::size_t both = 0, either = 0;
  for (std::size_t i = 0; i < first.grid.count(); ++i) {
    const double a = thickness_or_none(first.deposit_thickness[i]), b = thickness_or_none(other.values[i]);
    ours.add(a);
    theirs.add(b);
    if (a > 0 || b > 0) found.difference.values[i] = b - a;
    found.larger = std::max(found.larger, b - a);
    found.smaller = std::max(found.smaller, a - b);
    both += a > threshold && b > threshold;
    if (!(a > threshold) && !(b > threshold)) continue;
    ++either;
    squares.add((b - a) * (b - a));
    changes.push_back(std::abs(b - a));
  }
  const double area = first.grid.cell * first.grid.cell, scale = theirs.value() > 0 ? ours.value() / theirs.value() : 0;
  Sum moved;
  for (std::size_t i = 0; i < first.grid.count(); ++i)
    moved.add(0.5 *
              std::abs(thickness_or_none(first.deposit_thickness[i]) - scale * thickness_or_none(other.values[i])));
  found.volume = (theirs.value() - ours.value()) * area;
  found.moved = ours.value() > 0 ? moved.value() / ours.value() : 0;
  found.overlap = either > 0 ? static_cast<double>(both) / static_cast<double>(either) : 1;
  found.p99 = either > 0 ? quantile(std::move(changes), 0.99) : 0;
  found.rms = either > 0 ? std::sqrt(squares.value() / static_cast<double>(either)) : 0;
  return found;
}

}  // namespace talus::postprocess
