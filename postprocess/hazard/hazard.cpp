// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/hazard/hazard.hpp"

#include "common/gis/dataset_files.hpp"
#include "common/gis/polygons.hpp"

namespace talus::postprocess {

std::filesystem::path obstacles_beside(const std::filesystem::path& run_file) {
  return run_file.parent_path() / "obstacles.gpkg";
}

std::vector<std::filesystem::path> hazard_inputs(const Options& options, const std::filesystem::path& run_file) {
  std::vector<std::filesystem::path> files;
  if (!options.buildings.polygons.empty()) files = with_sidecars({options.buildings.polygons});
  if (std::filesystem::exists(obstacles_beside(run_file))) files.push_back(obstacles_beside(run_file));
  return files;
}

Hazard hazard_of(const Run& run, const Options& options, const std::filesystem::path& obstacles) {
  Hazard hazard;
  const std::string& crs = run.maps.grid.crs_wkt;
  if (options.intensity.guideline != Guideline::none) hazard.intensity = intensity_of(run.maps, options.intensity);
  hazard.cones = reach_cones(run.maps, run.summary.volume_released, options.footprint_threshold, options.reach_cone);
  if (std::filesystem::exists(obstacles)) hazard.obstacles = read_polygons(obstacles, crs);
  std::vector<MapPolygon> footprints;
  if (!options.buildings.polygons.empty()) footprints = read_polygons(options.buildings.polygons, crs);
  hazard.buildings = buildings_of(run, footprints, hazard.obstacles, options.buildings);
  return hazard;
}

}  // namespace talus::postprocess
