// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/hazard.hpp"

#include <algorithm>
#include <string_view>

#include <fmt/format.h>

#include "postprocess/ensemble/maps_of_ensemble.hpp"

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

}  // namespace talus::postprocess
