// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What comes to buildings: thickness, speed, pressure, thrust and time of arrival by footprint.
#pragma once

#include <string>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/hazard.hpp"

namespace talus::postprocess {

/// The largest of a quantity about a building, with the 99th percentile of its cells.
struct Extreme {
  double largest = 0, p99 = 0;
};

/// How the thrust on a building is known.
enum class ForceSource { none, pressure, obstacle };

/// What came to a building.
struct Building {
  std::vector<MapPolygon> parts;  ///< footprints; polygons of one name are one building
  std::string name;               ///< of the polygon; "building 3" where it has none
  int cells = 0;                  ///< of the map, in it or touching it
  Extreme thickness;              ///< over time [m]
  Extreme speed;                  ///< [m/s]
  Extreme pressure;               ///< density times speed squared [kPa]
  double arrival = nan;           ///< the first of its cells [s]; NaN where nothing came
  double width = 0;               ///< the largest extent of the footprint in plan [m]
  double force = 0;               ///< thrust [N]
  ForceSource source = ForceSource::none;
};

/// What came to each of the footprints, and to each obstacle that is not among them by name.
///
/// Cells count whose centres lie in a footprint or within half a cell's diagonal of it; about an obstacle within two
/// cells, since the grid's functions hold the mass off by as much. The thrust on a building that the
/// computation knew as an obstacle is the largest mean force between two records of the history, from the impulse that
/// contact gave it. On another, through which the flow went as if it were not there, F = c p A (Hungr, Morgan &
/// Kellerhals 1984, with c = 1): p the largest density times speed squared of a cell, A the
/// thickness there, no more than the building's height where that is known, times the width that the footprint can at
/// most turn to the flow. The largest thickness and pressure of a cell need not come together: a bound.
std::vector<Building> buildings_of(const Run& run, const std::vector<MapPolygon>& footprints,
                                   const std::vector<MapPolygon>& obstacles, const BuildingOptions& options);

/// A row for every building, under names that carry their units.
std::string buildings_table(const std::vector<Building>& buildings);

/// "obstacle", "pressure" or "".
const char* source_word(ForceSource source);

}  // namespace talus::postprocess
