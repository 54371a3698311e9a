// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/picture/search_words.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <optional>

#include "postprocess/picture/furniture.hpp"

namespace talus::postprocess {
namespace {

/// A number that the search has left in run.h5, as stability.NAME.
std::optional<double> searched(const PictureInput& input, const std::string& name) {
  const auto& facts = input.run.summary.provenance;
  const auto fact = std::ranges::find(facts, "stability." + name, [](const auto& f) { return f.first; });
  if (fact == facts.end()) return {};
  char* end = nullptr;
  const double value = std::strtod(fact->second.c_str(), &end);
  if (end == fact->second.c_str()) return {};
  return value;
}

}  // namespace

bool shows_search(const PictureInput& input) { return !input.instant && !input.run.maps.critical_thickness.empty(); }

std::string search_line(const PictureInput& input) {
  const auto factor = searched(input, "factor_of_safety"), volume = searched(input, "critical_volume_m3");
  const std::string ground = volume_words(input.run.summary.volume_released);
  if (!factor || !volume) return "no factor of safety found  \u00b7  " + ground + " of ground";
  return fmt::format("factor of safety {:.2f}  \u00b7  {} of {} fail first", *factor, volume_words(*volume), ground);
}

std::vector<std::pair<std::string, std::string>> search_numbers(const PictureInput& input) {
  std::vector<std::pair<std::string, std::string>> rows{{"Ground", volume_words(input.run.summary.volume_released)}};
  const auto row = [&](const char* name, const char* words, const auto& text) {
    if (const auto value = searched(input, name)) rows.emplace_back(words, text(*value));
  };
  const auto factor = [](double f) { return fmt::format("{:.3f}", f); };
  row("factor_of_safety", "Factor of safety", factor);
  row("lower_factor", "Rests at", factor);
  row("upper_factor", "Fails at", factor);
  row("critical_volume_m3", "Fails first", volume_words);
  row("critical_area_m2", "Its area", [](double area) { return fmt::format("{:.2f} ha", area / 1e4); });
  row("critical_depth_m", "Deepest", [](double depth) { return fmt::format("{:.1f}\u2009m", depth); });
  return rows;
}

}  // namespace talus::postprocess
