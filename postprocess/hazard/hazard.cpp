// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/hazard/hazard.hpp"

#include <string_view>

#include "common/gis/dataset_files.hpp"
#include "common/gis/polygons.hpp"

namespace talus::postprocess {
namespace {

/// The footprints of a run's obstacles; each ring a polygon of its own.
std::vector<MapPolygon> obstacles_in(const RunSummary& run) {
  constexpr std::string_view kind = "obstacle ";
  std::vector<MapPolygon> polygons;
  for (const MapPlace& place : run.places) {
    if (!place.words.starts_with(kind)) continue;
    for (const auto& ring : place.rings)
      if (ring.size() > 2) polygons.push_back({{ring}, {}, place.words.substr(kind.size())});
  }
  return polygons;
}

}  // namespace

std::vector<std::filesystem::path> hazard_inputs(const Options& options) {
  return options.buildings.polygons.empty() ? std::vector<std::filesystem::path>{}
                                            : with_sidecars({options.buildings.polygons});
}

Hazard hazard_of(const Run& run, const Options& options) {
  Hazard hazard;
  if (options.intensity.guideline != Guideline::none) hazard.intensity = intensity_of(run.maps, options.intensity);
  hazard.cones = reach_cones(run.maps, run.summary.volume_released, options.footprint_threshold, options.reach_cone);
  hazard.obstacles = obstacles_in(run.summary);
  std::vector<MapPolygon> footprints;
  if (!options.buildings.polygons.empty())
    footprints = read_polygons(options.buildings.polygons, run.maps.grid.crs_wkt);
  hazard.buildings = buildings_of(run, footprints, hazard.obstacles, options.buildings);
  return hazard;
}

}  // namespace talus::postprocess
