// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/map/places.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace talus {

using Json = nlohmann::ordered_json;

std::string places_json(const std::vector<MapPlace>& places) {
  Json json = Json::array();
  for (MapPlace place : places) {
    for (auto& ring : place.rings)
      for (auto& [x, y] : ring) {
        x = std::round(100 * x) / 100;
        y = std::round(100 * y) / 100;
      }
    json.push_back({{"words", place.words}, {"rings", place.rings}});
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<std::vector<MapPlace>> places_in(const std::string& text) {
  std::vector<MapPlace> places;
  try {
    const Json json = Json::parse(text);
    if (!json.is_array()) return std::nullopt;
    for (const Json& one : json) {
      places.push_back({one.at("words").get<std::string>(), {}});
      one.at("rings").get_to(places.back().rings);
      for (const auto& ring : places.back().rings)
        if (ring.empty()) return std::nullopt;
    }
  } catch (const Json::exception&) {
    return std::nullopt;
  }
  return places;
}

}  // namespace talus
