// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the gauges, sections, inflows and obstacles of a run are.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace talus {

/// A thing that stands on the map: a point (one ring of one vertex), a line, or the rings of polygons.
struct MapPlace {
  std::string words;  ///< "gauge bridge", "obstacle wall": as the history's columns name it
  std::vector<std::vector<std::array<double, 2>>> rings;  ///< map coordinates [m]
  bool operator==(const MapPlace&) const = default;
};

/// Places as JSON, coordinates to a centimetre.
std::string places_json(const std::vector<MapPlace>& places);

/// The places of such a text; none where it is no such text.
std::optional<std::vector<MapPlace>> places_in(const std::string& json);

}  // namespace talus
