// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/hazard/intensity.hpp"

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

/// Limits of a guideline: class `first_code` + k is reached at the k-th of them.
struct Limits {
  std::string guideline, source;
  std::vector<std::string> names;  ///< of the classes, that of whatever was reached first where `first_is_reach`
  IntensityOptions at;
  int first_code = 1;
  bool first_is_reach = true;  ///< whatever the flow reached is of the first class
};

Limits limits_of(const IntensityOptions& o) {
  const char* federal = "BWW, BRP & BUWAL (1997), hazards of floods in land-use planning";
  const char* observed = "Kang & Kim (2014), damage of buildings by debris flows";
  switch (o.guideline) {
    case Guideline::swiss_debris_flow:
      return {
          "swiss-debris-flow", federal, {"medium", "strong"}, {.thickness = {1}, .speed = {1}, .rule = Rule::all}, 2};
    case Guideline::swiss_flood:
      return {"swiss-flood",
              federal,
              {"weak", "medium", "strong"},
              {.thickness = {0.5, 2}, .thickness_speed = {0.5, 2}, .rule = Rule::any}};
    case Guideline::swiss_avalanche:
      return {"swiss-avalanche",
              "BFF & SLF (1984), avalanche hazard in land-use planning",
              {"weak", "medium", "strong"},
              {.pressure = {3, 30}, .rule = Rule::any}};
    case Guideline::debris_flow_concrete:
      return {"debris-flow-concrete",
              observed,
              {"slight damage", "moderate damage", "extensive damage"},
              {.pressure = {35, 100}, .rule = Rule::any}};
    case Guideline::debris_flow_other:
      return {"debris-flow-other",
              observed,
              {"slight damage", "extensive damage", "complete destruction"},
              {.pressure = {15, 30}, .rule = Rule::any}};
    case Guideline::none:
    case Guideline::own: break;
  }
  Limits own{"own", "limits of the recipe", {}, o, 1, false};
  const std::size_t count = std::max({o.thickness.size(), o.speed.size(), o.thickness_speed.size(), o.pressure.size()});
  for (std::size_t k = 0; k < count; ++k) own.names.push_back(fmt::format("class {}", k + 1));
  return own;
}

/// A quantity with its limits.
struct Quantity {
  const char* name;
  const char* unit;
  const std::vector<double>& limits;
};

std::string words_of(const Limits& limits, std::size_t k) {
  const Quantity quantities[] = {{"thickness", "m", limits.at.thickness},
                                 {"speed", "m/s", limits.at.speed},
                                 {"thickness times speed", "m2/s", limits.at.thickness_speed},
                                 {"pressure", "kPa", limits.at.pressure}};
  std::string words;
  for (const Quantity& q : quantities) {
    if (k >= q.limits.size()) continue;
    if (!words.empty()) words += limits.at.rule == Rule::any ? " or " : " and ";
    words += fmt::format("{} \u2265 {:g} {}", q.name, q.limits[k], q.unit);
  }
  return words;
}

/// The number of limits that a cell reaches by a rule.
std::size_t reached(const IntensityOptions& o, double h, double v, double p) {
  const std::pair<const std::vector<double>*, double> quantities[] = {
      {&o.thickness, h}, {&o.speed, v}, {&o.thickness_speed, h * v}, {&o.pressure, p}};
  std::size_t most = 0, least = 99;
  for (const auto& [limits, value] : quantities) {
    if (limits->empty()) continue;
    std::size_t count = 0;
    while (count < limits->size() && value >= (*limits)[count]) ++count;
    most = std::max(most, count);
    least = std::min(least, count);
  }
  return o.rule == Rule::any ? most : least;
}

/// Yellow, orange, red and on, as hazard maps have them: lightness falls with the class.
std::vector<Colour> colours_of(std::size_t count) {
  if (count == 2) return {{0.99, 0.70, 0.25}, {0.80, 0.12, 0.12}};
  if (count == 3) return {{0.99, 0.90, 0.45}, {0.96, 0.60, 0.18}, {0.76, 0.08, 0.10}};
  std::vector<Colour> colours;
  for (std::size_t k = 0; k < count; ++k) colours.push_back(class_colour(k, count));
  return colours;
}

std::vector<IntensityClass> classes_of(const Limits& limits) {
  const auto colours = colours_of(limits.names.size());
  std::vector<IntensityClass> classes;
  for (std::size_t k = 0; k < limits.names.size(); ++k) {
    const bool plain = limits.first_is_reach && k == 0;
    const std::size_t limit = limits.first_is_reach ? k - 1 : k;
    classes.push_back({.code = limits.first_code + static_cast<int>(k),
                       .name = limits.names[k],
                       .words = plain ? "wherever the flow came" : words_of(limits, limit),
                       .colour = colours[k]});
  }
  return classes;
}

}  // namespace

IntensityMap intensity_of(const RunMaps& maps, const IntensityOptions& options) {
  const Limits limits = limits_of(options);
  IntensityMap map{limits.guideline, limits.source, classes_of(limits), std::vector<double>(maps.grid.count(), nan)};
  const std::vector<char> inside = inside_domain(maps);
  for (std::size_t i = 0; i < map.codes.size(); ++i) {
    if (inside[i] == 0) continue;
    map.codes[i] = 0;
    if (!(maps.peak_thickness[i] > maps.threshold)) continue;
    std::size_t count = reached(limits.at, maps.peak_thickness[i], maps.peak_speed[i], maps.peak_pressure_kPa[i]);
    if (limits.first_is_reach) ++count;
    if (count == 0) continue;
    IntensityClass& here = map.classes[count - 1];
    here.area += maps.grid.cell * maps.grid.cell;
    map.codes[i] = here.code;
  }
  return map;
}

}  // namespace talus::postprocess
