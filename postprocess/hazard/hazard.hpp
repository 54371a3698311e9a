// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// All that an authority asks of a run's maps, computed once for maps, scores, picture and report.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/map/colours.hpp"
#include "common/map/polygon.hpp"
#include "common/run/map_fields.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"

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

struct IntensityClass {
  int code = 0;       ///< on the map
  std::string name;   ///< "medium"
  std::string words;  ///< the limits: "thickness >= 1 m and speed >= 1 m/s"
  Colour colour;
  double area = 0;  ///< of the cells of this class, in plan [m2]
};

/// A map of codes: NaN outside the domain, 0 where nothing came.
struct IntensityMap {
  std::string guideline;  ///< as recipes call it
  std::string source;     ///< whose limits they are
  std::vector<IntensityClass> classes;
  std::vector<double> codes;  ///< [rows * columns]
};

/// The class of every cell that the flow reached, thicker than the run's threshold, by the largest thickness h, speed v
/// and pressure p there over time, and by their product h v. The largest of h and of v need not come together: h v is
/// a bound, on the safe side. Limits and sources of the guidelines stand in hazard.cpp; of own limits class k is where
/// any, or all, of the quantities given reach their k-th limit, none below the first.
IntensityMap intensity_of(const RunMaps& maps, const IntensityOptions& options);

/// What a mass reaches that falls by an angle of reach (Fahrboeschung; Heim 1932) from every cell of its release.
struct ReachCone {
  std::string name;    ///< "Corominas 1996"; "angle_deg" for the recipe's own
  double tangent = 0;  ///< H/L [-]
  /// Height of the energy line above the ground where it passes, from the release on over cells that it passes: NaN
  /// elsewhere. sqrt(2 g head) bounds the speed there (Körner 1980). [rows * columns] [m]
  std::vector<double> head;
  double area = 0;     ///< in plan, of the cells reached [m2]
  double covered = 0;  ///< share of the run's footprint that lies within [-]; NaN where there is no footprint
};

/// 1 in the cells that a cone reaches, else 0, so that an outline passes between those and the others.
std::vector<double> reached_cells(const ReachCone& cone);

/// The cones that the recipe asks for: its own angle first, then those usual for the released volume (the regressions
/// of common/map/usual_reach.hpp that hold for it), flatter ones last. `footprint`: peak thickness from which the run's
/// footprint counts [m]. Empty where nothing was released.
std::vector<ReachCone> reach_cones(const RunMaps& maps, double volume, double footprint,
                                   const ReachConeOptions& options);

/// What the recipe asks for; empty where it does not.
struct Hazard {
  std::optional<IntensityMap> intensity;
  std::vector<ReachCone> cones;
  std::vector<Building> buildings;
  std::vector<MapPolygon> obstacles;  ///< footprints, `name` as in the recipe; they are among the buildings too
};

/// Computes it, with the obstacles among the run's places. Throws DataError where polygons cannot be read.
Hazard hazard_of(const Run& run, const Options& options);

}  // namespace talus::postprocess
