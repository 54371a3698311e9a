// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// All that an authority asks of a run's maps, computed once for maps, scores, picture and report.
#pragma once

#include <filesystem>
#include <optional>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/hazard/buildings.hpp"
#include "postprocess/hazard/intensity.hpp"
#include "postprocess/hazard/reach_cone.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// What the recipe asks for; empty where it does not.
struct Hazard {
  std::optional<IntensityMap> intensity;
  std::vector<ReachCone> cones;
  std::vector<Building> buildings;
  std::vector<MapPolygon> obstacles;  ///< footprints, `name` as in the recipe; they are among the buildings too
};

/// The files that hazard_of() reads, with what lies beside them.
std::vector<std::filesystem::path> hazard_inputs(const Options& options);

/// Computes it. Obstacles are those that the run names with their places (common/map/places.hpp). Throws DataError
/// where a file of polygons cannot be read.
Hazard hazard_of(const Run& run, const Options& options);

}  // namespace talus::postprocess
