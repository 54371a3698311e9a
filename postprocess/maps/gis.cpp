// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/maps.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <iomanip>
#include <sstream>

#include <fmt/format.h>

#include "common/gis/crs.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/writers/job.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

OutlineFeature above(const Raster& raster, const std::string& what, double threshold, const std::string& unit) {
  return {fmt::format("{} > {:g} {}", what, threshold, unit),
          outline_above(raster, threshold),
          {{"threshold_" + unit, threshold}}};
}

OutlineLayer deposit_layer(const Run& run, const Options& options) {
  auto limits = thickness_limits(options.classes, run.maps.deposit_thickness);
  limits.push_back(options.deposit_threshold);
  std::sort(limits.begin(), limits.end());
  limits.erase(std::unique(limits.begin(), limits.end()), limits.end());
  OutlineLayer layer{"deposit", {}};
  for (const double limit : limits)
    layer.features.push_back(above({run.maps.grid, run.maps.deposit_thickness}, "deposit", limit, "m"));
  return layer;
}

OutlineLayer pressure_layer(const Run& run) {
  OutlineLayer layer{"pressure", {}};
  for (const double limit : pressure_limits(run.maps.peak_pressure_kPa))
    layer.features.push_back(above({run.maps.grid, run.maps.peak_pressure_kPa}, "peak pressure", limit, "kPa"));
  return layer;
}

OutlineLayer survey_layer(const Survey& survey, const Options& options) {
  OutlineLayer layer{"survey", {}};
  if (!survey.polygons.empty())
    layer.features.push_back({survey.name + ": outline", survey.polygons, {}});
  else if (!survey.footprint.empty())
    layer.features.push_back(
        above({survey.grid, survey.footprint}, survey.name + ": footprint", survey.footprint_threshold, "m"));
  if (!survey.deposit.empty())
    layer.features.push_back(
        above({survey.grid, survey.deposit}, survey.name + ": deposit", options.deposit_threshold, "m"));
  return layer;
}

constexpr std::size_t most_frames = 60;  // a layer each: more of them open slowly

/// The thickest of all frames decides on the classes, which all of them share.
RasterStyle flow_style(const Run& run, const std::vector<double>& given) {
  double thickest = 0;
  for (const auto& frame : run.frames.thickness) thickest = std::max(thickest, largest(frame));
  return class_style(thickness_limits(given, {thickest}), "m");
}

/// `seconds` after `start` ("1903-04-29 04:10:00", UTC), to a millisecond: "1903-04-29T04:11:40.500Z".
std::string instant_after(const std::string& start, double seconds) {
  using namespace std::chrono;
  std::tm begin{};
  std::istringstream(start) >> std::get_time(&begin, "%Y-%m-%d %H:%M:%S");
  const sys_days date{year{begin.tm_year + 1900} / (begin.tm_mon + 1) / begin.tm_mday};
  const auto at = sys_time<milliseconds>(date) + hours{begin.tm_hour} + minutes{begin.tm_min} +
                  std::chrono::seconds{begin.tm_sec} + milliseconds{std::llround(1000 * seconds)};
  const auto midnight = floor<days>(at);
  const year_month_day civil{midnight};
  const hh_mm_ss clock{at - midnight};
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.{:03}Z", static_cast<int>(civil.year()),
                     static_cast<unsigned>(civil.month()), static_cast<unsigned>(civil.day()), clock.hours().count(),
                     clock.minutes().count(), clock.seconds().count(), clock.subseconds().count());
}

/// Which of `count` frames are shown, `most` of them at most: all, or evenly chosen with the first and the last.
std::vector<std::size_t> shown_frames(std::size_t count, std::size_t most) {
  std::vector<std::size_t> chosen;
  const std::size_t shown = std::min(count, most);
  for (std::size_t k = 0; k < shown; ++k)
    chosen.push_back(shown < 2 ? 0 : (k * (count - 1) + (shown - 1) / 2) / (shown - 1));
  return chosen;
}

/// Thickness at each frame, from maps/results.nc, in the classes of the deposit; not shown at first. Each lasts until
/// the next begins. Without layers where the run has fewer than two frames.
ProjectGroup flow_group(const Run& run, const Options& options) {
  ProjectGroup group{"Flow over time (Temporal Controller)", {}, false};
  const auto& time = run.frames.time;
  const auto chosen = shown_frames(time.size(), most_frames);
  if (chosen.size() < 2) return group;
  const std::string start = options.start_time.empty() ? nominal_start : options.start_time;
  RasterStyle style = flow_style(run, options.classes);
  for (std::size_t k = 0; k < chosen.size(); ++k) {
    const bool last = k + 1 == chosen.size();
    const double begin = time[chosen[k]];
    const double end = last ? begin + (begin - time[chosen[k - 1]]) : time[chosen[k + 1]];
    style.band = static_cast<int>(chosen[k]) + 1;
    group.layers.push_back({fmt::format("Thickness at {:g} s [m]", begin), "NETCDF:\"results.nc\":thickness", true,
                            style, ProjectTime{instant_after(start, begin), instant_after(start, end)}});
  }
  return group;
}

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
  std::vector<double> surface(maps.grid.count(), nan);
  for (std::size_t c = 0; c < surface.size(); ++c)
    if (maps.critical_thickness[c] > maps.threshold) surface[c] = maps.before[c] - maps.critical_thickness[c];
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
  group.layers.insert(group.layers.end(),
                      {outline(fmt::format("Deposit above {:g} m", deposit),
                               fmt::format("deposit|subset=threshold_m = {}", deposit), deposit_line),
                       outline(fmt::format("Peak thickness above {:g} m", footprint), "footprint", footprint_line),
                       outline("Deposit, every class", "deposit", class_line, false),
                       outline("Peak pressure, every class", "pressure", pressure_line, false)});
  return group;
}

/// What the legend says of a map; maps without words of their own are named after their file.
std::string legend_name(const std::string& map) {
  for (const MapField& field : map_fields)
    if (map == field.name) return field.product.legend;
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

}  // namespace

std::vector<OutlineLayer> map_outlines(const Run& run, const Options& options, const std::optional<Survey>& survey) {
  const auto& maps = run.maps;
  std::vector<OutlineLayer> layers{
      {"footprint", {above({maps.grid, maps.peak_thickness}, "peak thickness", options.footprint_threshold, "m")}},
      deposit_layer(run, options),
      pressure_layer(run),
      {"release", {above({maps.grid, maps.initial_thickness}, "release", options.deposit_threshold, "m")}}};
  if (!maps.critical_thickness.empty())
    layers.push_back(
        {"critical", {above({maps.grid, maps.critical_thickness}, "critical mass", options.deposit_threshold, "m")}});
  if (survey) layers.push_back(survey_layer(*survey, options));
  return layers;
}

Writer gis_writer() {
  std::vector<std::string> names = names_of_maps(".qml");
  names.insert(names.end(), {"maps/terrain.tif", "maps/terrain.qml", "maps/sliding_surface.tif", "maps/outlines.gpkg",
                             "maps/*.qgs"});
  return {.name = "QGIS project",
          .names = std::move(names),
          .write =
              [](const Job& job) {
                const fs::path folder = folder_of(job, "maps");
                return write_gis(folder, geotiff_files(folder, job.run.maps), job);
              },
          .outdated = std::vector<std::string>{}};
}

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
