// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/survey/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/polygons.hpp"
#include "common/gis/raster_file.hpp"
#include "common/gis/read_raster.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/cells_inside.hpp"
#include "postprocess/survey/survey_grid.hpp"

namespace talus::postprocess {
namespace {

namespace fs = std::filesystem;

std::string box(const MapGrid& grid) {
  return fmt::format("x {:.1f} to {:.1f}, y {:.1f} to {:.1f}", grid.west, grid.east(), grid.south, grid.north());
}

void check_overlap(const fs::path& file, const Survey& survey, const RunMaps& maps) {
  const auto& values = survey.deposit.empty() ? survey.footprint : survey.deposit;
  for (int row = 0; row < survey.grid.rows; ++row) {
    const double y = survey.grid.y(row);
    if (y < maps.grid.south || y > maps.grid.north()) continue;
    for (int column = 0; column < survey.grid.columns; ++column) {
      const double x = survey.grid.x(column);
      if (x > maps.grid.west && x < maps.grid.east() && std::isfinite(values[survey.grid.index(column, row)])) return;
    }
  }
  throw DataError({fmt::format("{}: no surveyed cell lies in the run's area", file.string()),
                   fmt::format("survey {}; run {}", box(survey.grid), box(maps.grid)),
                   "Give the survey of this event, in the run's coordinates"});
}

Raster read_values(const fs::path& file, const RunMaps& maps) {
  auto raster = read_raster(file);
  check_crs(file, raster.grid, maps.grid);
  return raster;
}

Raster read_thickness(const fs::path& file, const SurveyOptions& options, const RunMaps& maps) {
  auto raster = read_values(file, maps);
  to_vertical(raster, options, maps);
  return raster;
}

/// after - before on the grid of the after DEM, or on the run's where that DEM has another CRS.
void read_surfaces(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  auto after = read_raster_in_metres(options.after_dem, maps.grid.crs_wkt);
  survey.inputs.push_back(options.after_dem);
  if (after.grid.crs_wkt.empty() != maps.grid.crs_wkt.empty()) check_crs(options.after_dem, after.grid, maps.grid);
  if (!same_crs(after.grid.crs_wkt, maps.grid.crs_wkt)) after = resample_elevation(after, maps.grid);
  Raster before{maps.grid, maps.before};
  if (!options.before_dem.empty()) {
    before = read_raster_in_metres(options.before_dem, maps.grid.crs_wkt);
    survey.inputs.push_back(options.before_dem);
  }
  if (!same_grid(before.grid, after.grid) || !same_crs(before.grid.crs_wkt, after.grid.crs_wkt)) {
    before = resample_elevation(before, after.grid);
  }
  survey.grid = after.grid;
  for (std::size_t i = 0; i < after.values.size(); ++i) survey.measured.push_back(after.values[i] - before.values[i]);
}

void read_footprint(const SurveyOptions& options, const RunMaps& maps, double threshold, Survey& survey) {
  const bool has_grid = !survey.deposit.empty();
  if (!options.peak_thickness.empty() || !options.polygon.empty()) survey.footprint_is_change = false;
  if (!options.peak_thickness.empty()) {
    auto peak = read_thickness(options.peak_thickness, options, maps);
    survey.inputs.push_back(options.peak_thickness);
    if (!has_grid) survey.grid = peak.grid;
    survey.footprint = same_grid(peak.grid, survey.grid) ? peak.values : resample_thickness(peak, survey.grid).values;
    survey.footprint_threshold = threshold;
  } else if (!options.polygon.empty()) {
    if (!has_grid) survey.grid = maps.grid;
    survey.polygons = read_polygons(options.polygon, survey.grid.crs_wkt);
    survey.inputs.push_back(vector_source(options.polygon).file);
    const auto inside = cells_inside(survey.polygons, survey.grid);
    survey.footprint.assign(inside.begin(), inside.end());
    survey.footprint_threshold = 0.5;
    if (std::none_of(survey.footprint.begin(), survey.footprint.end(), [](double v) { return v > 0; })) {
      throw DataError({fmt::format("{}: no polygon covers a cell of the run's area", options.polygon.string()),
                       fmt::format("run {}", box(survey.grid)),
                       "Give the outline of this event, in the run's coordinates"});
    }
  }
}

}  // namespace

std::optional<Survey> read_survey(const SurveyOptions& options, const RunMaps& maps, double footprint_threshold) {
  if (!options.given()) return std::nullopt;
  Survey survey;
  survey.name = options.name;
  survey.kind = options.kind;
  if (!options.after_dem.empty()) {
    read_surfaces(options, maps, survey);
  } else if (options.measures()) {
    const auto& file = options.thickness.empty() ? options.difference : options.thickness;
    auto raster = options.thickness.empty() ? read_values(file, maps) : read_thickness(file, options, maps);
    survey.grid = raster.grid;
    survey.measured = std::move(raster.values);
    survey.inputs.push_back(file);
  }
  if (options.measures()) {
    survey.deposit_is_change = survey.footprint_is_change = options.thickness.empty();
    read_error(options, maps, survey);
    auto seen = detected(survey, survey.measured);
    survey.deposit = std::move(seen.deposit);
    if (survey.footprint_is_change) survey.footprint = std::move(seen.footprint);
    survey.footprint_threshold = footprint_threshold;
  }
  read_footprint(options, maps, footprint_threshold, survey);
  check_overlap(survey.inputs.front(), survey, maps);
  return survey;
}

OnSurveyGrid bring_to_survey_grid(const RunMaps& maps, const Survey& survey) {
  const auto bring = [&](const std::vector<double>& values) { return on_grid({maps.grid, values}, survey.grid); };
  OnSurveyGrid simulated{bring(maps.deposit_thickness), {}, bring(maps.peak_thickness), 0};
  auto initial =
      survey.deposit_is_change ? bring(maps.initial_thickness) : std::vector<double>(survey.grid.count(), 0.0);
  if (survey.deposit_is_change && !maps.eroded_depth.empty()) {
    const auto eroded = bring(maps.eroded_depth);
    for (std::size_t i = 0; i < eroded.size(); ++i) {
      if (std::isfinite(eroded[i])) initial[i] = (std::isnan(initial[i]) ? 0 : initial[i]) + eroded[i];
    }
  }
  const auto& surveyed = survey.deposit.empty() ? survey.footprint : survey.deposit;
  const double area = survey.grid.cell * survey.grid.cell;
  for (std::size_t i = 0; i < surveyed.size(); ++i) {
    double& h = simulated.deposit[i];
    double& peak = simulated.peak[i];
    h = std::isnan(h) ? 0 : h;
    peak = std::isnan(peak) ? 0 : peak;
    const double change = h - (std::isnan(initial[i]) ? 0 : initial[i]);
    if (survey.deposit_is_change) h = std::max(0.0, change);
    simulated.change.push_back(survey.deposit_is_change ? change : h);
    if (std::isfinite(surveyed[i])) continue;
    simulated.deposit_left_out += h * area;
    h = simulated.change.back() = std::numeric_limits<double>::quiet_NaN();
  }
  return simulated;
}

}  // namespace talus::postprocess
