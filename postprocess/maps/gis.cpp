// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/gis.hpp"

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/gis/geotiff.hpp"
#include "common/gis/outlines.hpp"
#include "common/qgis/project.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/fields/styles.hpp"
#include "postprocess/fields/window.hpp"
#include "postprocess/maps/geotiff.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

// As in the picture: green for what was released, ink for what was touched, blue and dashed for what was surveyed.
const OutlineStyle release_line{{0.0, 0.45, 0.36}, 0.7, false};
const OutlineStyle footprint_line{{0.12, 0.12, 0.14}, 0.35, false};
const OutlineStyle deposit_line{{0.47, 0.15, 0.0}, 0.5, false};
const OutlineStyle class_line{{0.47, 0.15, 0.0}, 0.2, false};
const OutlineStyle pressure_line{{0.45, 0.0, 0.45}, 0.35, false};
const OutlineStyle survey_line{{0.0, 0.30, 0.70}, 0.7, true};
const OutlineStyle critical_line{{0.75, 0.0, 0.10}, 0.7, false};

fs::path write_elevation(fs::path file, const Run& run, const std::vector<double>& values,
                         const std::string& quantity) {
  write_cog(file, {run.maps.grid, values}, plain_tags(run, quantity, "m"));
  return file;
}

/// The surface under the mass that fails first, as talus-preprocess takes it (`sliding_surface`): no data beside it.
std::vector<double> surface_under(const RunMaps& maps) {
  std::vector<double> surface(maps.grid.count(), std::numeric_limits<double>::quiet_NaN());
  for (std::size_t c = 0; c < surface.size(); ++c) {
    if (maps.critical_thickness[c] > maps.threshold) surface[c] = maps.before[c] - maps.critical_thickness[c];
  }
  return surface;
}

ProjectLayer outline(const std::string& name, const std::string& layer, const OutlineStyle& style, bool shown = true) {
  return {name, "outlines.gpkg|layername=" + layer, shown, style};
}

ProjectGroup outline_group(const Job& job) {
  const auto& options = job.options;
  ProjectGroup group{"Outlines", {}};
  if (job.survey)
    group.layers.push_back(
        outline((job.survey->kind == ReferenceKind::model ? "Reference: " : "Survey: ") + job.survey->name, "survey",
                survey_line));
  const double deposit = options.deposit_threshold, footprint = options.footprint_threshold;
  group.layers.push_back(outline("Release", "release", release_line));
  if (!job.run.maps.critical_thickness.empty())
    group.layers.push_back(outline("Critical mass", "critical", critical_line));
  group.layers.push_back(outline(fmt::format("Deposit above {:g} m", deposit),
                                 fmt::format("deposit|subset=threshold_m = {}", deposit), deposit_line));
  group.layers.push_back(outline(fmt::format("Peak thickness above {:g} m", footprint), "footprint", footprint_line));
  group.layers.push_back(outline("Deposit, every class", "deposit", class_line, false));
  group.layers.push_back(outline("Peak pressure, every class", "pressure", pressure_line, false));
  return group;
}

/// What the legend says of a map; maps without words of their own are named after their file.
std::string legend_name(const std::string& map) {
  for (const MapField& field : map_fields) {
    if (map == field.name) return field.product.legend;
  }
  std::string name = map;
  std::replace(name.begin(), name.end(), '_', ' ');
  return name + " [m]";
}

/// What stands around the map on paper.
PrintLayout print_layout(const Job& job) {
  const RunSummary& s = job.run.summary;
  const std::string crs = crs_name(job.run.maps.grid.crs_wkt);
  PrintLayout page{.title = s.title, .subtitle = {}, .sources = {}};
  page.subtitle = fmt::format("Landslide run-out simulation, scene {}, {:g} s simulated; {}", s.scene, s.time_end,
                              crs.empty() ? "local coordinates [m]" : crs);
  page.sources = fmt::format("Talus {}, material point method; map cell {:g} m; run {}.", s.version,
                             job.run.maps.grid.cell, fact(s.provenance, run_id));
  if (job.survey && job.survey->name != "survey") page.sources += " Reference: " + job.survey->name + ".";
  if (!job.options.institution.empty()) page.sources += " Made by " + job.options.institution + ".";
  page.sources +=
      " Thickness is vertical. Shading: ground before the failure. One run is one scenario, not a hazard map.";
  return page;
}

QgisProject project_of(const std::vector<fs::path>& maps, const Job& job) {
  const Run& run = job.run;
  const Options& options = job.options;
  const Window window = affected_window(run.maps, options, job.survey);
  QgisProject project{
      run.summary.title, run.maps.grid.crs_wkt, {window.west, window.south, window.east, window.north}, {}};
  project.groups.push_back(outline_group(job));
  for (ProjectGroup& group : hazard_groups(job.hazard)) project.groups.push_back(std::move(group));
  ProjectGroup results{"Maps", {}};
  for (const auto& map : maps) {
    const std::string name = map.stem().string();
    const bool shown = name == "deposit_thickness";
    results.layers.push_back(
        {legend_name(name), map.filename().string(), shown, map_style(name, run.maps, options.classes)});
  }
  project.groups.push_back(std::move(results));
  if (ProjectGroup flow = flow_group(run, options); !flow.layers.empty()) project.groups.push_back(std::move(flow));
  project.groups.push_back({"Ground", {{"Terrain before the failure", "terrain.tif", true, HillshadeStyle{}}}});
  project.layout = print_layout(job);
  return project;
}

class GisWriter : public Writer {
 public:
  std::string name() const override { return "QGIS project"; }
  std::vector<std::string> names() const override {
    auto files = names_of_maps(".qml");
    files.insert(files.end(), {"maps/terrain.tif", "maps/terrain.qml", "maps/sliding_surface.tif", "maps/outlines.gpkg",
                               "maps/*.qgs"});
    return files;
  }
  std::vector<std::string> outdated() const override { return {}; }
  Files write(const Job& job) const override {
    const fs::path folder = folder_of(job, "maps");
    return write_gis(folder, geotiff_files(folder, job.run.maps), job);
  }
};

}  // namespace

std::shared_ptr<Writer> gis_writer() { return std::make_shared<GisWriter>(); }

std::vector<fs::path> write_gis(const fs::path& folder, const std::vector<fs::path>& maps, const Job& job) {
  const auto& run = job.run;
  std::vector<fs::path> files;
  for (const auto& map : maps)
    files.push_back(write_qgis_style(map, map_style(map.stem().string(), run.maps, job.options.classes)));
  const fs::path outlines = folder / "outlines.gpkg";
  const fs::path terrain =
      write_elevation(folder / "terrain.tif", run, run.maps.before, "elevation of the ground before the failure");
  if (!run.maps.critical_thickness.empty())
    files.push_back(write_elevation(folder / "sliding_surface.tif", run, surface_under(run.maps),
                                    "elevation of the surface under the mass that fails first"));
  write_outlines(outlines, run.maps.grid.crs_wkt, map_outlines(run, job.options, job.survey));
  const fs::path project = folder / (file_word(run.summary.scene) + ".qgs");
  write_qgis_project(project, project_of(maps, job));
  files.insert(files.end(), {terrain, write_qgis_hillshade_style(terrain), outlines, project});
  return files;
}

}  // namespace talus::postprocess
