// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/sensitivity.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <fmt/format.h>

#include "common/ensemble/openturns.hpp"

namespace talus::postprocess {
namespace {

using Measure = SensitivityMeasure;

/// Members by which indices can be told at all.
constexpr std::size_t fewest_members = 4;

bool varies(const std::vector<double>& values) {
  return std::adjacent_find(values.begin(), values.end(), std::not_equal_to<>()) != values.end();
}

std::vector<double> chosen(const std::vector<double>& values, const std::vector<std::size_t>& places) {
  std::vector<double> some;
  for (const std::size_t place : places) some.push_back(values[place]);
  return some;
}

Sensitivity sobol(const MemberTable& table, const std::vector<double>& result) {
  const auto size = static_cast<std::size_t>(table.sample_size);
  const std::size_t blocks = table.columns.size() + 2;
  if (size * blocks != result.size()) throw std::logic_error("sensitivity: the design has another number of blocks");
  std::vector<std::size_t> whole;
  for (std::size_t k = 0; k < size; ++k) {
    bool all = true;
    for (std::size_t block = 0; block < blocks; ++block) all = all && std::isfinite(result[block * size + k]);
    if (all) whole.push_back(k);
  }
  Sensitivity found;
  found.members = static_cast<std::int64_t>(whole.size() * blocks);
  if (whole.size() < size)
    found.note = fmt::format("{} of {} rows of the design are left out: one of their members has no result",
                             size - whole.size(), size);
  std::vector<std::size_t> places;
  for (std::size_t block = 0; block < blocks; ++block)
    for (const std::size_t k : whole) places.push_back(block * size + k);
  const std::vector<double> values = chosen(result, places);
  if (whole.size() < fewest_members || !varies(values)) {
    found.note = whole.size() < fewest_members ? "too few members" : "the result is the same in all members";
    return found;
  }
  std::vector<std::vector<double>> inputs;
  for (const MemberColumn& column : table.columns) inputs.push_back(chosen(column.values, places));
  const openturns::SobolIndices indices = openturns::library().sobol_indices(inputs, values, whole.size());
  for (std::size_t n = 0; n < table.columns.size(); ++n) {
    const std::string& key = table.columns[n].key;
    found.indices.push_back({key, Measure::first_order, indices.first[n], indices.first_low[n], indices.first_high[n]});
    found.indices.push_back({key, Measure::total_order, indices.total[n], indices.total_low[n], indices.total_high[n]});
  }
  return found;
}

/// Results of the middle, and of the members that differ from it in one key alone.
Sensitivity swings(const MemberTable& table, const std::vector<double>& result) {
  Sensitivity found;
  for (std::size_t n = 0; n < table.columns.size(); ++n) {
    std::vector<double> values;
    for (std::size_t k = 0; k < result.size(); ++k) {
      bool alone = std::isfinite(result[k]);
      for (std::size_t other = 0; other < table.columns.size() && alone; ++other)
        alone = other == n || table.columns[other].values[k] == table.columns[other].values[0];
      if (alone) values.push_back(result[k]);
    }
    found.members += static_cast<std::int64_t>(values.size());
    if (values.size() < 2) continue;
    const auto [least, most] = std::minmax_element(values.begin(), values.end());
    found.indices.push_back({table.columns[n].key, Measure::swing, *most - *least, nan, nan});
  }
  if (found.indices.empty()) found.note = "too few members";
  return found;
}

/// Confidence of a rank correlation.
SensitivityIndex spearman_index(const std::string& key, double value, std::size_t members) {
  const double z = std::atanh(std::clamp(value, -0.999999, 0.999999));
  const double half = 1.959964 * std::sqrt(1.06 / (static_cast<double>(members) - 3));
  return {key, Measure::spearman, value, std::tanh(z - half), std::tanh(z + half)};
}

Sensitivity ranks(const MemberTable& table, const std::vector<double>& result) {
  std::vector<std::size_t> places;
  for (std::size_t k = 0; k < result.size(); ++k)
    if (std::isfinite(result[k])) places.push_back(k);
  const std::vector<double> values = chosen(result, places);
  Sensitivity found;
  found.members = static_cast<std::int64_t>(places.size());
  if (places.size() < fewest_members || !varies(values)) {
    found.note = places.size() < fewest_members ? "too few members" : "the result is the same in all members";
    return found;
  }
  std::vector<std::vector<double>> inputs;
  std::vector<std::string> keys, left_out;
  for (const MemberColumn& column : table.columns) {
    std::vector<double> input = chosen(column.values, places);
    if (column.words.size() > 2 || !varies(input)) {
      left_out.push_back(column.key);
      continue;
    }
    keys.push_back(column.key);
    inputs.push_back(std::move(input));
  }
  if (!left_out.empty()) found.note = fmt::format("no ranks: {}", fmt::join(left_out, ", "));
  if (keys.empty()) return found;
  const std::vector<double> correlation = openturns::library().rank_correlations(inputs, values);
  for (std::size_t n = 0; n < keys.size(); ++n)
    found.indices.push_back(spearman_index(keys[n], correlation[n], places.size()));
  if (places.size() < keys.size() + 2) return found;
  const std::vector<double> regression = openturns::library().rank_regression(inputs, values);
  for (std::size_t n = 0; n < regression.size(); ++n)
    found.indices.push_back({keys[n], Measure::srrc, regression[n], nan, nan});
  return found;
}

}  // namespace

Sensitivity sensitivity(const MemberTable& table, const std::vector<double>& result) {
  if (result.size() != static_cast<std::size_t>(table.count))
    throw std::logic_error("sensitivity: a result of other members");
  if (table.columns.empty()) return {{}, 0, "no key varies"};
  if (table.design == "sensitivity") return sobol(table, result);
  return table.design == "one-at-a-time" ? swings(table, result) : ranks(table, result);
}

std::string measure_name(SensitivityMeasure measure) {
  switch (measure) {
    case Measure::first_order: return "sobol_first_order";
    case Measure::total_order: return "sobol_total";
    case Measure::spearman: return "spearman_rank_correlation";
    case Measure::srrc: return "standardised_rank_regression";
    case Measure::swing: break;
  }
  return "swing";
}

std::string measure_title(SensitivityMeasure measure) {
  switch (measure) {
    case Measure::first_order: return "Sobol index, first order";
    case Measure::total_order: return "Sobol index, total";
    case Measure::spearman: return "Spearman's rank correlation";
    case Measure::srrc: return "Standardised rank regression";
    case Measure::swing: break;
  }
  return "Swing, one key at a time";
}

bool has_sensitivity(const RowColumn& column) {
  if (column.kind == ColumnKind::input) return false;
  return column.name != "steps" && column.name != "wall_time_s" && column.name != "time_end_s";
}

std::string sensitivity_csv(const std::vector<std::pair<std::string, Sensitivity>>& results) {
  const auto number = [](double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : std::string(); };
  std::string text = "result,key,measure,value,low_95,high_95,members,note\n";
  for (const auto& [name, found] : results) {
    const std::string note = found.note.empty() ? "" : "\"" + found.note + "\"";
    if (found.indices.empty()) text += fmt::format("{},,,,,,{},{}\n", name, found.members, note);
    for (const SensitivityIndex& index : found.indices)
      text += fmt::format("{},{},{},{},{},{},{},{}\n", name, index.key, measure_name(index.measure),
                          number(index.value), number(index.low), number(index.high), found.members, note);
  }
  return text;
}

}  // namespace talus::postprocess
