// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/maps.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "common/qgis/style.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

const OutlineStyle reach_line{{0.55, 0.10, 0.55}, 0.6, true};
const OutlineStyle building_line{{0.10, 0.10, 0.10}, 0.5, false};
const OutlineStyle obstacle_line{{0.75, 0.05, 0.05}, 0.8, false};

/// A class for each code, from just below it.
RasterStyle style_of(const IntensityMap& map) {
  RasterStyle style{{}, -std::numeric_limits<double>::infinity(), map.classes.front().code - 0.5, 0.85};
  for (const IntensityClass& one : map.classes)
    style.classes.push_back({one.code + 0.5, one.colour, one.name + ": " + one.words});
  style.classes.back().upper = std::numeric_limits<double>::infinity();
  return style;
}

void write_intensity(const fs::path& folder, const Run& run, const IntensityMap& map, std::vector<fs::path>& files) {
  RasterTags tags = plain_tags(run, "class of intensity, " + map.guideline, "1");
  tags.metadata.emplace_back("GUIDELINE", map.source);
  for (const IntensityClass& one : map.classes)
    tags.metadata.emplace_back(fmt::format("CLASS_{}", one.code), one.name + ": " + one.words);
  tags.metadata.emplace_back("NODATA_MEANING", "outside the computed domain; 0: below all classes");
  files.push_back(folder / "intensity.tif");
  write_cog(files.back(), {run.maps.grid, map.codes}, tags);
  files.push_back(write_qgis_style(files.back(), style_of(map)));
}

double degrees_of(const ReachCone& cone) { return std::atan(cone.tangent) * 180 / std::numbers::pi; }

std::string title_of(const ReachCone& cone) {
  if (cone.name == "angle_deg") return fmt::format("angle of reach {:.1f} deg", degrees_of(cone));
  return fmt::format("{}, {:.1f} deg", cone.name, degrees_of(cone));
}

void write_reach(const fs::path& folder, const Run& run, const std::vector<ReachCone>& cones,
                 std::vector<fs::path>& files) {
  RasterTags tags = plain_tags(run, "height of the energy line above the ground, " + title_of(cones.front()), "m");
  tags.metadata.emplace_back("H_OVER_L", fmt::format("{:.6g}", cones.front().tangent));
  tags.metadata.emplace_back("NODATA_MEANING", "not reached");
  files.push_back(folder / "reach_cone.tif");
  write_cog(files.back(), {run.maps.grid, cones.front().head}, tags);
  files.push_back(
      write_qgis_style(files.back(), class_style(thickness_limits({}, cones.front().head), "m", Ramp::sea)));
  OutlineLayer layer{"reach", {}};
  for (const ReachCone& cone : cones)
    layer.features.push_back({title_of(cone),
                              outline_above({run.maps.grid, reached_cells(cone)}, 0.5),
                              {{"angle_deg", degrees_of(cone)}, {"h_over_l", cone.tangent}}});
  files.push_back(folder / "reach.gpkg");
  write_outlines(files.back(), run.maps.grid.crs_wkt, {layer});
}

OutlineFeature feature_of(const Building& b) {
  OutlineFeature feature{b.name, b.parts, {}};
  feature.numbers = {{"thickness_max_m", b.thickness.largest},
                     {"thickness_p99_m", b.thickness.p99},
                     {"speed_max_m_s", b.speed.largest},
                     {"speed_p99_m_s", b.speed.p99},
                     {"pressure_max_kPa", b.pressure.largest},
                     {"pressure_p99_kPa", b.pressure.p99},
                     {"width_m", b.width},
                     {"force_N", b.force},
                     {"force_is_counted", b.source == ForceSource::obstacle ? 1.0 : 0.0}};
  if (!std::isnan(b.arrival)) feature.numbers.emplace_back("arrival_s", b.arrival);
  return feature;
}

void write_buildings(const fs::path& folder, const Run& run, const Hazard& hazard, std::vector<fs::path>& files) {
  std::vector<OutlineLayer> layers{{"buildings", {}}};
  for (const Building& b : hazard.buildings) layers[0].features.push_back(feature_of(b));
  if (!hazard.obstacles.empty()) {
    layers.push_back({"obstacles", {}});
    for (const MapPolygon& polygon : hazard.obstacles) layers[1].features.push_back({polygon.name, {polygon}, {}});
  }
  files.push_back(folder / "buildings.gpkg");
  write_outlines(files.back(), run.maps.grid.crs_wkt, layers);
}

/// Writes what there is of intensity.tif, reach_cone.tif (the first cone), each with its style, reach.gpkg (the outline
/// of every cone, `angle_deg`, `h_over_l`) and buildings.gpkg (layers `buildings`, `obstacles`). Returns the files.
std::vector<fs::path> write_hazard_maps(const fs::path& folder, const Run& run, const Hazard& hazard) {
  std::vector<fs::path> files;
  if (hazard.intensity) write_intensity(folder, run, *hazard.intensity, files);
  if (!hazard.cones.empty()) write_reach(folder, run, hazard.cones, files);
  if (!hazard.buildings.empty()) write_buildings(folder, run, hazard, files);
  return files;
}

}  // namespace

Writer hazard_writer() {
  return {.name = "hazard maps",
          .names = {"maps/intensity.tif", "maps/intensity.qml", "maps/reach_cone.tif", "maps/reach_cone.qml",
                    "maps/reach.gpkg", "maps/buildings.gpkg"},
          .write = [](const Job& job) { return write_hazard_maps(folder_of(job, "maps"), job.run, job.hazard); }};
}

Writer buildings_writer() {
  return {
      .name = "buildings",
      .names = {"buildings.csv"},
      .write =
          [](const Job& job) { return Files{write_file(job, "buildings.csv", buildings_table(job.hazard.buildings))}; },
      .asked_for = [](const Job& job) { return !job.hazard.buildings.empty(); }};
}

std::vector<ProjectGroup> hazard_groups(const Hazard& hazard) {
  ProjectGroup lines{"Hazard", {}}, rasters{"Hazard maps", {}};
  if (!hazard.obstacles.empty())
    lines.layers.push_back({"Obstacles", "buildings.gpkg|layername=obstacles", true, obstacle_line});
  if (!hazard.buildings.empty())
    lines.layers.push_back({"Buildings", "buildings.gpkg|layername=buildings", true, building_line});
  if (!hazard.cones.empty()) {
    lines.layers.push_back({"Angle of reach", "reach.gpkg|layername=reach", true, reach_line});
    rasters.layers.push_back({"Height of the energy line [m]", "reach_cone.tif", false,
                              class_style(thickness_limits({}, hazard.cones.front().head), "m", Ramp::sea)});
  }
  if (hazard.intensity)
    rasters.layers.insert(rasters.layers.begin(), {"Intensity, " + hazard.intensity->guideline, "intensity.tif", false,
                                                   style_of(*hazard.intensity)});
  std::vector<ProjectGroup> groups;
  for (ProjectGroup* group : {&lines, &rasters})
    if (!group->layers.empty()) groups.push_back(std::move(*group));
  return groups;
}

}  // namespace talus::postprocess
