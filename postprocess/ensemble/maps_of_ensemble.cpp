// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/maps_of_ensemble.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

std::size_t tally_of(HazardIntensity intensity) {
  const char* name = intensity == HazardIntensity::peak_pressure    ? "peak_pressure"
                     : intensity == HazardIntensity::peak_thickness ? "peak_thickness"
                                                                    : "peak_speed";
  std::size_t place = 0;
  while (std::string_view(counted_maps[place].name) != name) ++place;
  return place;
}

/// The usual limits: of snow avalanches' pressure (BFF and SLF 1984); of thickness and speed 1 m and 1 m/s, which part
/// medium from strong debris flows (BWW, BRP and BUWAL 1997), and half of that.
std::vector<double> usual_limits(HazardIntensity intensity) {
  return intensity == HazardIntensity::peak_pressure ? std::vector<double>{3, 30} : std::vector<double>{0.5, 1};
}

using Kind = EnsembleMapKind;

/// A unit as part of a file's name: "m_s".
std::string unit_in_name(const std::string& unit) {
  std::string word = unit_words(unit);
  std::replace(word.begin(), word.end(), '/', '_');
  return word;
}

std::string name_in_file(const CountedMap& map) { return map.early ? "arrival" : map.name; }

void add_thresholds(std::vector<EnsembleMap>& maps, std::size_t tally, const std::vector<double>& thresholds) {
  const CountedMap& map = counted_maps[tally];
  for (std::size_t n = 0; n < thresholds.size(); ++n) {
    const double level = thresholds[n];
    const std::string name =
        fmt::format("{}_{}_{:g}_{}", name_in_file(map), map.early ? "before" : "above", level, unit_in_name(map.unit));
    const std::string what = fmt::format("{} of {}", words_of(map), threshold_words(map, level));
    maps.push_back({Kind::share, tally, n, level, name, "Probability of " + what, "1"});
    maps.push_back(
        {Kind::error, tally, n, level, name + "_error", "Standard error of the probability of " + what, "1"});
    maps.push_back({Kind::to_halve, tally, n, level, name + "_members_to_halve",
                    "Members that would halve the error of the probability of " + what, "1"});
  }
}

void add_statistics(std::vector<EnsembleMap>& maps, std::size_t tally) {
  const CountedMap& map = counted_maps[tally];
  const std::string file = name_in_file(map), words = words_of(map);
  for (const double share : quantile_shares)
    maps.push_back({Kind::quantile, tally, 0, share, fmt::format("{}_q{:02.0f}", file, 100 * share),
                    fmt::format("{:g} % quantile of {}", 100 * share, words), map.unit});
  const char* over = map.early ? " over the members that arrive" : "";
  maps.push_back({Kind::mean, tally, 0, nan, file + "_mean", fmt::format("Mean {}{}", words, over), map.unit});
  maps.push_back({Kind::deviation, tally, 0, nan, file + "_deviation",
                  fmt::format("Standard deviation of {}{}", words, over), map.unit});
}

double value_of(const MapTally& tally, const EnsembleMap& map, std::size_t cell, std::int64_t counted, double draws) {
  const CountedMap& what = counted_maps[map.tally];
  const auto share = [&] { return tally.exceeded[map.threshold][cell] / static_cast<double>(counted); };
  switch (map.kind) {
    case Kind::share: return share();
    case Kind::error: return standard_error(share(), draws);
    case Kind::to_halve: return std::ceil(members_to_halve(share(), draws) * static_cast<double>(counted) / draws);
    case Kind::quantile: return tally.quantile(what, cell, map.level, counted);
    case Kind::mean: return tally.mean(what, cell, counted);
    case Kind::deviation: return tally.deviation(what, cell, counted);
    case Kind::count: return tally.exceeded[map.threshold][cell];
    case Kind::largest: return tally.largest(what, cell);
    case Kind::hazard: break;
  }
  return nan;
}

}  // namespace

std::optional<HazardRule> hazard_rule(const Ensemble& ensemble, const HazardOptions& options) {
  if (!ensemble.table.names.empty()) return std::nullopt;  // slides or a budget: no sample
  HazardRule rule{.tally = tally_of(options.intensity),
                  .thresholds = {},
                  .intensity = options.limits.empty() ? usual_limits(options.intensity) : options.limits,
                  .probability = options.probability,
                  .matrix = options.matrix};
  const std::vector<double>& counted = ensemble.counts.maps[rule.tally].thresholds;
  for (const double limit : rule.intensity) {
    const auto found = std::find(counted.begin(), counted.end(), limit);
    if (found != counted.end()) {
      rule.thresholds.push_back(static_cast<std::size_t>(found - counted.begin()));
    } else if (options.limits.empty()) {
      return std::nullopt;
    } else {
      const CountedMap& map = counted_maps[rule.tally];
      throw DataError({fmt::format("[postprocess.hazard] limits names {}", threshold_words(map, limit)),
                       fmt::format("the runs were counted at {} {}", fmt::join(counted, ", "), unit_words(map.unit)),
                       "Name one of these, or add it to [ensemble.thresholds] and run talus-preprocess and "
                       "talus-solve again"});
    }
  }
  return rule;
}

/// The largest class that an intensity and its probability give, by place of the counts; 0 where none does.
std::vector<double> hazard_classes(const Ensemble& ensemble, const HazardRule& rule) {
  const MapTally& tally = ensemble.counts.maps[rule.tally];
  const auto members = static_cast<double>(ensemble.counted());
  const std::size_t columns = rule.probability.size();
  std::vector<double> classes(tally.reached.size(), 0.0);
  for (std::size_t row = 0; row < rule.thresholds.size(); ++row) {
    const std::vector<std::uint32_t>& exceeded = tally.exceeded[rule.thresholds[row]];
    for (std::size_t cell = 0; cell < classes.size(); ++cell) {
      const double share = exceeded[cell] / members;
      if (exceeded[cell] == 0) continue;
      const auto above = std::upper_bound(rule.probability.begin(), rule.probability.end(), share);
      if (above == rule.probability.begin()) continue;
      const auto column = static_cast<std::size_t>(above - rule.probability.begin()) - 1;
      classes[cell] = std::max(classes[cell], static_cast<double>(rule.matrix[row * columns + column]));
    }
  }
  return classes;
}

std::string hazard_words(const HazardRule& rule) {
  std::string words;
  for (std::size_t row = 0; row < rule.intensity.size(); ++row) {
    const CountedMap& map = counted_maps[rule.tally];
    words += fmt::format("{}{} of {}:", row == 0 ? "" : "; ", words_of(map), threshold_words(map, rule.intensity[row]));
    for (std::size_t column = 0; column < rule.probability.size(); ++column)
      words += fmt::format("{} {} from probability {:g}", column == 0 ? "" : ",",
                           rule.matrix[row * rule.probability.size() + column], rule.probability[column]);
  }
  return words;
}

std::string words_of(const CountedMap& map) {
  std::string words = map.name;
  std::replace(words.begin(), words.end(), '_', ' ');
  return words;
}

std::string unit_words(const std::string& unit) { return unit == "m s-1" ? "m/s" : unit == "1" ? "" : unit; }

std::string threshold_words(const CountedMap& map, double threshold) {
  return fmt::format("{:g} {} or {}", threshold, unit_words(map.unit), map.early ? "less" : "more");
}

std::vector<EnsembleMap> ensemble_maps(const Ensemble& ensemble, const HazardOptions& hazard) {
  std::vector<EnsembleMap> maps;
  for (std::size_t tally = 0; tally < counted_map_count; ++tally)
    add_thresholds(maps, tally, ensemble.counts.maps[tally].thresholds);
  for (std::size_t tally = 0; tally < counted_map_count; ++tally) add_statistics(maps, tally);
  if (const auto rule = hazard_rule(ensemble, hazard))
    maps.push_back({Kind::hazard, rule->tally, 0, nan, "hazard_class", "Hazard class", "1"});
  return maps;
}

KeptValues kept_values(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard) {
  if (map.kind == Kind::hazard) return {hazard_classes(ensemble, hazard_rule(ensemble, hazard).value()), 0};
  const MapTally& tally = ensemble.counts.maps[map.tally];
  const std::int64_t counted = ensemble.counted();
  const double draws = independent_draws(ensemble.table, counted);
  KeptValues kept;
  kept.elsewhere = value_of(MapTally(tally.thresholds, 1, tally.tallied), map, 0, counted, draws);
  for (std::size_t place = 0; place < tally.reached.size(); ++place)
    kept.values.push_back(tally.reached[place] > 0 ? value_of(tally, map, place, counted, draws) : kept.elsewhere);
  return kept;
}

std::vector<double> values_of(const Ensemble& ensemble, const EnsembleMap& map, const HazardOptions& hazard) {
  const EnsembleCounts& counts = ensemble.counts;
  const std::vector<char> inside = inside_domain(base_maps(counts.scene));
  const std::vector<std::uint32_t> reached = counts.cells.spread(counts.maps[map.tally].reached, 0u);
  const KeptValues kept = kept_values(ensemble, map, hazard);
  std::vector<double> values = counts.cells.spread(kept.values, kept.elsewhere);
  for (std::size_t cell = 0; cell < values.size(); ++cell)
    if (!inside[cell] && reached[cell] == 0) values[cell] = nan;
  return values;
}

std::vector<double> limits_of(const EnsembleMap& map, const std::vector<double>& values) {
  const std::string_view unit = map.unit;
  switch (map.kind) {
    case Kind::share: return {0.01, 0.05, 0.1, 0.25, 0.5, 0.75, 0.95};
    case Kind::error: return {0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1};
    case Kind::to_halve: return {10, 100, 1000, 10000, 100000};
    case Kind::count: return {0.5, 1.5, 2.5, 5.5, 10.5, 20.5, 50.5};  // between whole numbers
    case Kind::hazard: return {1, 2, 3};
    default: break;
  }
  if (unit == "s") return time_limits(values);
  if (unit == "m s-1") return speed_limits(values);
  if (unit == "kPa") return pressure_limits(values);
  return thickness_limits({}, values);
}

RasterStyle style_of(const EnsembleMap& map, const std::vector<double>& values, const HazardOptions& hazard) {
  const std::vector<double> limits = limits_of(map, values);
  if (map.kind == Kind::hazard) {
    RasterStyle style;
    const int most = *std::max_element(hazard.matrix.begin(), hazard.matrix.end());
    for (int k = 1; k <= std::max(most, 1); ++k)
      style.classes.push_back({k < most ? k + 0.5 : std::numeric_limits<double>::infinity(),
                               class_colour(static_cast<std::size_t>(k - 1), static_cast<std::size_t>(most)),
                               fmt::format("class {}", k)});
    style.hidden_from = -1;
    style.hidden_to = 0.5;
    return style;
  }
  const bool by_time = map.unit == "s" && map.kind != Kind::deviation;
  if (by_time) return time_style(limits, "s");
  if (map.kind == Kind::count) {
    RasterStyle style = class_style(limits, "", Ramp::sea);
    const char* const words[] = {"1", "2", "3 \u2013 5", "6 \u2013 10", "11 \u2013 20", "21 \u2013 50", "> 50"};
    for (std::size_t n = 0; n < style.classes.size(); ++n) style.classes[n].label = words[n];
    return style;
  }
  const bool sea = map.kind == Kind::share || map.unit == "m s-1" || map.unit == "s";
  return class_style(limits, unit_words(map.unit), sea ? Ramp::sea : Ramp::heat);
}

}  // namespace talus::postprocess
