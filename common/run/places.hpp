// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Where the gauges and obstacles of a run are, as facts of its provenance: "place.gauge bridge" = "500050,5000100".
#pragma once

#include <array>
#include <string>
#include <utility>
#include <vector>

#include "common/map/polygon.hpp"

namespace talus {

/// A thing that stands on the map: a point (one ring of one vertex), or the rings of polygons.
struct MapPlace {
  std::string words;  ///< "gauge bridge", "obstacle wall": as the history's columns name it
  std::vector<std::vector<std::array<double, 2>>> rings;  ///< map coordinates [m]
};

/// The fact that tells a place: coordinates to a centimetre, vertices apart by spaces and rings by ";". Outlines that
/// would take more than 30 kB lose vertices evenly (an attribute of HDF5 holds 64 kB).
std::pair<std::string, std::string> place_fact(const MapPlace& place);

/// Whether a fact, by its name, tells a place.
bool is_place(const std::string& name);

/// The places among the facts of a run. Throws DataError for one that cannot be read.
std::vector<MapPlace> places_in(const std::vector<std::pair<std::string, std::string>>& facts);

}  // namespace talus
