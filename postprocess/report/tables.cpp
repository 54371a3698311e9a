// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of the report: scores, volumes, used recipes, buildings, places.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/map/slope.hpp"
#include "common/recipe/used.hpp"
#include "common/run/mobility.hpp"
#include "common/stage/findings.hpp"
#include "postprocess/fields/release.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/report/parts.hpp"

namespace talus::postprocess {
namespace {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

/// A thickness map read both ways. Vertical is how Talus means it; the other column is what the same numbers would be,
/// were they measured normal to the slope.
Json both_ways(const std::string& name, const Raster& thickness, const ReleaseNumbers& numbers, double limit) {
  double vertical = 0;
  for (const double h : thickness.values)
    if (h > 0) vertical += h * (thickness.grid.cell * thickness.grid.cell);
  return {{"name", name},
          {"volume", vertical},
          {"volume_if_normal", numbers.volume_if_normal},
          {"area_projected", numbers.area},
          {"area_true", numbers.true_area},
          {"thickest", numbers.thickest},
          {"thickest_normal", numbers.thickest_normal},
          {"limit", limit}};
}

Json entry_json(const ScoreEntry& entry) {
  Json json{{"key", entry.key}, {"label", entry.label}, {"unit", entry.unit}, {"decimals", entry.decimals}};
  std::visit([&](const auto& value) { json["value"] = value; }, entry.value);
  return json;
}

}  // namespace

Json score_json(const Score& score) {
  Json json{{"sections", Json::array()},
            {"not_scored", Json::array()},
            {"notes", score.notes},
            {"findings", Json::parse(to_json(score.findings))}};
  for (const auto& section : score.sections) {
    auto entries = Json::array();
    for (const auto& entry : section.entries) entries.push_back(entry_json(entry));
    json["sections"].push_back({{"title", section.title}, {"entries", std::move(entries)}});
  }
  for (const auto& [key, why] : score.not_scored) json["not_scored"].push_back({{"key", key}, {"why", why}});
  return json;
}

Json volumes_json(const Run& run, double deposit_threshold) {
  const auto cosine = slope_cosine({run.maps.grid, run.maps.terrain});
  const auto& maps = run.maps;
  auto bodies = Json::array();
  const double limit = release_limit(maps, deposit_threshold);
  bodies.push_back(both_ways("Release", {maps.grid, maps.initial_thickness}, release_numbers(run, limit), limit));
  const auto add = [&](const char* name, const Raster& thickness, double least) {
    bodies.push_back(both_ways(name, thickness, numbers_of(thickness, cosine, least), least));
  };
  add("Deposit", {maps.grid, maps.deposit_thickness}, deposit_threshold);
  if (!maps.eroded_depth.empty()) add("Eroded ground", {maps.grid, maps.eroded_depth}, 0);
  return bodies;
}

Json stages_json(const std::vector<StageText>& stages) {
  auto list = Json::array();
  for (const auto& stage : stages) {
    Json json{{"stage", stage.stage}, {"missing", !stage.text}, {"facts", Json::array()}, {"keys", Json::array()}};
    if (stage.text) {
      const auto used = recipe::read_used_recipe(*stage.text, stage.stage + ".used.toml");
      for (const auto& [name, value] : used.facts)
        if (name != "table" && name != "result" && name != "resolved") json["facts"].push_back({name, value});
      for (const auto& key : used.keys)
        json["keys"].push_back({{"table", key.table},
                                {"key", key.key},
                                {"value", key.value},
                                {"default", key.default_value ? Json(*key.default_value) : Json()}});
    }
    list.push_back(std::move(json));
  }
  return list;
}

namespace {

Json building_json(const Building& b) {
  return {{"name", b.name},
          {"arrival", finite_or_null(b.arrival)},
          {"thickness", {b.thickness.largest, b.thickness.p99}},
          {"speed", {b.speed.largest, b.speed.p99}},
          {"pressure", {b.pressure.largest, b.pressure.p99}},
          {"width", b.width},
          {"force", b.force},
          {"force_from", source_word(b.source)}};
}

}  // namespace

Json hazard_json(const ReportInput& input) {
  Json json{{"buildings", Json::array()}};
  if (input.hazard != nullptr)
    for (const Building& b : input.hazard->buildings) json["buildings"].push_back(building_json(b));
  return json;
}

namespace {

/// Of every quantity measured at a place its value farthest from zero, and when that was.
Json extremes_at(const std::string& place, const RunHistory& history) {
  auto list = Json::array();
  const HistoryColumn* time = history.find("time_s");
  for (const HistoryColumn& column : history.columns) {
    if (column.place != place || time == nullptr) continue;
    const auto farther = [](double a, double b) { return !std::isfinite(a) || std::abs(a) < std::abs(b); };
    const auto found = std::max_element(column.values.begin(), column.values.end(), farther);
    if (found == column.values.end() || !std::isfinite(*found)) continue;
    list.push_back({{"quantity", column.quantity},
                    {"unit", column.unit},
                    {"value", *found},
                    {"time", time->values[static_cast<std::size_t>(found - column.values.begin())]}});
  }
  return list;
}

}  // namespace

Json places_json(const ReportInput& input) {
  auto list = Json::array();
  const Window window = shown_window(input);
  for (const MapPlace& place : input.run.summary.places) {
    auto rings = Json::array();
    for (const auto& ring : place.rings) {
      auto flat = Json::array();
      for (const auto& [x, y] : ring) {
        flat.push_back(std::round(100 * (x - window.west)) / 100);
        flat.push_back(std::round(100 * (y - window.south)) / 100);
      }
      rings.push_back(std::move(flat));
    }
    const auto space = place.words.find(' ');
    list.push_back({{"kind", place.words.substr(0, space)},
                    {"name", space == std::string::npos ? place.words : place.words.substr(space + 1)},
                    {"rings", std::move(rings)},
                    {"measured", extremes_at(place.words, input.run.history)}});
  }
  return list;
}

}  // namespace talus::postprocess
