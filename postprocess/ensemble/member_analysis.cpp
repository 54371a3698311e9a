// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/member_analysis.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <random>
#include <stdexcept>
#include <utility>

#include <fmt/format.h>

#include "common/ensemble/openturns.hpp"
#include "common/stage/machine.hpp"

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

/// Some of the places from 0 to count - 1, the same ones every time.
std::vector<std::size_t> sampled_places(std::size_t count, std::size_t most) {
  std::vector<std::size_t> all(count), some;
  std::iota(all.begin(), all.end(), std::size_t{0});
  std::ranges::sample(all, std::back_inserter(some), static_cast<std::ptrdiff_t>(most), std::mt19937(1));
  return some;
}

/// Adds what any form of dependence tells of the keys.
void add_hsic(const std::vector<std::string>& keys, const std::vector<std::vector<double>>& inputs,
              const std::vector<double>& values, Sensitivity& found) {
  constexpr std::size_t most = 250;  // each with each
  constexpr double doubtful = 0.05;
  const std::vector<std::size_t> some = sampled_places(values.size(), most);
  const std::vector<double> outputs = chosen(values, some);
  std::vector<std::string> told, idle;
  std::vector<std::vector<double>> columns;
  for (std::size_t n = 0; n < keys.size() && varies(outputs); ++n)
    if (auto column = chosen(inputs[n], some); varies(column)) {
      told.push_back(keys[n]);
      columns.push_back(std::move(column));
    }
  if (told.empty()) return;
  const std::vector<openturns::Dependence> dependence = openturns::library().hsic(columns, outputs);
  for (std::size_t n = 0; n < dependence.size(); ++n) {
    found.indices.push_back({told[n], Measure::hsic, dependence[n].r2, nan, nan});
    if (dependence[n].chance > doubtful) idle.push_back(told[n]);
  }
  if (idle.empty()) return;
  found.note += fmt::format("{}no effect is told (HSIC, p > {}) of {}", found.note.empty() ? "" : "; ", doubtful,
                            fmt::join(idle, ", "));
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
  if (places.size() >= keys.size() + 2) {
    const std::vector<double> regression = openturns::library().rank_regression(inputs, values);
    for (std::size_t n = 0; n < regression.size(); ++n)
      found.indices.push_back({keys[n], Measure::srrc, regression[n], nan, nan});
  }
  add_hsic(keys, inputs, values, found);
  return found;
}

/// Distances of every two of the members that are looked at.
class Distances {
 public:
  Distances(const EnsembleCounts& counts, const std::vector<std::int64_t>& members) : count_(members.size()) {
    values_.assign(count_ * count_, 0.0);
    in_threads(count_, "comparing the footprints", [&](std::size_t a) {
      for (std::size_t b = a + 1; b < count_; ++b)
        values_[a * count_ + b] = values_[b * count_ + a] = jaccard_distance(
            counts.flow[static_cast<std::size_t>(members[a])], counts.flow[static_cast<std::size_t>(members[b])]);
    });
  }
  std::size_t count() const { return count_; }
  double operator()(std::size_t a, std::size_t b) const { return values_[a * count_ + b]; }

  /// The nearest of some, and the sum of all distances from their nearest.
  std::size_t nearest(std::size_t a, const std::vector<std::size_t>& some) const {
    return *std::min_element(some.begin(), some.end(),
                             [&](std::size_t one, std::size_t other) { return (*this)(a, one) < (*this)(a, other); });
  }
  double cost(const std::vector<std::size_t>& some) const {
    double sum = 0;
    for (std::size_t a = 0; a < count_; ++a) sum += (*this)(a, nearest(a, some));
    return sum;
  }

 private:
  std::size_t count_;
  std::vector<double> values_;
};

/// Adds the one that lowers the cost most.
bool build(const Distances& distances, std::vector<std::size_t>& chosen) {
  double best = chosen.empty() ? std::numeric_limits<double>::infinity() : distances.cost(chosen);
  std::size_t found = distances.count();
  for (std::size_t a = 0; a < distances.count(); ++a) {
    chosen.push_back(a);
    if (const double cost = distances.cost(chosen); cost < best - 1e-12) {
      best = cost;
      found = a;
    }
    chosen.pop_back();
  }
  if (found < distances.count()) chosen.push_back(found);
  return found < distances.count();
}

/// Puts another in the place of one where that lowers the cost, once over all pairs.
bool swap(const Distances& distances, std::vector<std::size_t>& chosen) {
  bool better = false;
  double best = distances.cost(chosen);
  for (std::size_t& place : chosen)
    for (std::size_t a = 0; a < distances.count(); ++a) {
      const std::size_t before = std::exchange(place, a);
      const double cost = distances.cost(chosen);
      if (cost < best - 1e-12) {
        best = cost;
        better = true;
      } else {
        place = before;
      }
    }
  return better;
}

}  // namespace

Sensitivity sensitivity(const MemberTable& table, const std::vector<double>& result) {
  if (result.size() != static_cast<std::size_t>(table.count))
    throw std::logic_error("sensitivity: a result of other members");
  if (table.columns.empty()) return {{}, 0, "no key varies"};
  if (table.design == "sensitivity") return sobol(table, result);
  return table.design == "one-at-a-time" ? swings(table, result) : ranks(table, result);
}

const MeasureWords& measure_words(SensitivityMeasure measure) {
  static const MeasureWords words[] = {{"sobol_first_order", "Sobol index, first order"},
                                       {"sobol_total", "Sobol index, total"},
                                       {"spearman_rank_correlation", "Spearman's rank correlation"},
                                       {"standardised_rank_regression", "Standardised rank regression"},
                                       {"r2_hsic", "R2-HSIC"},
                                       {"swing", "Swing, one key at a time"}};
  return words[static_cast<std::size_t>(measure)];
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
      text += fmt::format("{},{},{},{},{},{},{},{}\n", name, index.key, measure_words(index.measure).name,
                          number(index.value), number(index.low), number(index.high), found.members, note);
  }
  return text;
}

double jaccard_distance(const Footprint& a, const Footprint& b) {
  std::int64_t common = 0, either = 0;
  std::size_t at_a = 0, at_b = 0;
  std::int64_t left_a = a.empty() ? 0 : a[0], left_b = b.empty() ? 0 : b[0];
  while (at_a < a.size() && at_b < b.size()) {
    const std::int64_t step = std::min(left_a, left_b);
    const bool in_a = at_a % 2 == 1, in_b = at_b % 2 == 1;
    if (in_a && in_b) common += step;
    if (in_a || in_b) either += step;
    left_a -= step;
    left_b -= step;
    if (left_a == 0 && ++at_a < a.size()) left_a = a[at_a];
    if (left_b == 0 && ++at_b < b.size()) left_b = b[at_b];
  }
  return either > 0 ? 1 - static_cast<double>(common) / static_cast<double>(either) : 0;
}

Medoids medoids(const EnsembleCounts& counts, std::size_t wanted, std::size_t most) {
  constexpr int most_rounds = 20;
  std::vector<std::int64_t> members;
  for (std::size_t k = 0; k < counts.states.size() && members.size() < most; ++k)
    if (counts.states[k] == MemberState::counted) members.push_back(static_cast<std::int64_t>(k));
  const Distances distances(counts, members);
  std::vector<std::size_t> chosen;
  while (chosen.size() < wanted && build(distances, chosen)) {
  }
  for (int round = 0; round < most_rounds && swap(distances, chosen); ++round) {
  }
  Medoids found;
  found.represented_by.assign(counts.states.size(), -1);
  std::vector<std::int64_t> sizes(members.size(), 0);
  for (std::size_t a = 0; a < members.size() && !chosen.empty(); ++a) {
    const std::size_t medoid = distances.nearest(a, chosen);
    ++sizes[medoid];
    found.represented_by[static_cast<std::size_t>(members[a])] = members[medoid];
  }
  std::stable_sort(chosen.begin(), chosen.end(), [&](std::size_t a, std::size_t b) { return sizes[a] > sizes[b]; });
  for (const std::size_t medoid : chosen) {
    found.members.push_back(members[medoid]);
    found.counts.push_back(sizes[medoid]);
  }
  if (!members.empty() && !chosen.empty())
    found.mean_distance = distances.cost(chosen) / static_cast<double>(members.size());
  return found;
}

}  // namespace talus::postprocess
