#include "postprocess/score/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/raster/raster_file.hpp"
#include "common/raster/slope.hpp"

namespace talus::postprocess {
namespace {

namespace fs = std::filesystem;

bool same_grid(const MapGrid& a, const MapGrid& b) {
  const double slack = 1e-6 * a.cell;
  return a.columns == b.columns && a.rows == b.rows && std::abs(a.west - b.west) < slack &&
         std::abs(a.south - b.south) < slack && std::abs(a.cell - b.cell) * std::max(a.columns, a.rows) < slack;
}

void check_crs(const fs::path& file, const MapGrid& grid, const MapGrid& run) {
  if (same_crs(grid.crs_wkt, run.crs_wkt)) return;
  const auto mend = run.crs_wkt.empty() || grid.crs_wkt.empty()
                        ? fmt::format("If the coordinates fit, name the CRS: gdal_edit.py -a_srs {} {}",
                                      run.crs_wkt.empty() ? "None" : crs_name(run.crs_wkt), file.string())
                        : fmt::format("Reproject: gdalwarp -t_srs {} {} out.tif", crs_name(run.crs_wkt), file.string());
  throw DataError({fmt::format("{}: CRS is {}", file.string(), crs_name(grid.crs_wkt)),
                   fmt::format("the run is in {}", crs_name(run.crs_wkt)), mend});
}

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

std::vector<double> on_grid(const Raster& raster, const MapGrid& grid) {
  return same_grid(raster.grid, grid) ? raster.values : resample_thickness(raster, grid).values;
}

void zero_for_nodata(std::vector<double>& values) {
  for (double& v : values) {
    if (std::isnan(v)) v = 0;
  }
}

Raster read_thickness(const fs::path& file, const SurveyOptions& options, const RunMaps& maps) {
  auto raster = read_raster(file);
  check_crs(file, raster.grid, maps.grid);
  if (options.nodata_is_zero) zero_for_nodata(raster.values);
  if (options.direction == Direction::slope_normal) {
    const auto cosine = on_grid({maps.grid, slope_cosine({maps.grid, maps.terrain})}, raster.grid);
    for (std::size_t i = 0; i < cosine.size(); ++i) {
      if (cosine[i] > 0) raster.values[i] /= cosine[i];  // beyond the run's ground: as it is
    }
  }
  return raster;
}

/// after - before on the grid of the after DEM, or on the run's where that DEM has another CRS.
void read_change(const SurveyOptions& options, const RunMaps& maps, double footprint_threshold, Survey& survey) {
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
  survey.deposit_is_change = survey.footprint_is_change = true;
  survey.footprint_threshold = footprint_threshold;
  for (std::size_t i = 0; i < after.values.size(); ++i) {
    const double change = after.values[i] - before.values[i];
    survey.deposit.push_back(std::isnan(change) ? change : std::max(0.0, change));
    survey.footprint.push_back(std::abs(change));
  }
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
    survey.inputs.push_back(options.polygon);
    survey.footprint = rasterize(survey.polygons, survey.grid);
    survey.footprint_threshold = 0.5;
    if (std::none_of(survey.footprint.begin(), survey.footprint.end(), [](double v) { return v > 0; })) {
      throw DataError({fmt::format("{}: no polygon covers a cell of the run's area", options.polygon.string()),
                       fmt::format("run {}", box(survey.grid)),
                       "Give the outline of this event, in the run's coordinates"});
    }
  }
}

/// Where a row's centre line crosses the rings of one polygon, west to east.
std::vector<double> crossings(const MapPolygon& polygon, double y) {
  std::vector<double> places;
  for (const auto& ring : polygon.rings) {
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const auto& a = ring[i];
      const auto& b = ring[(i + 1) % ring.size()];
      if ((a[1] > y) != (b[1] > y)) places.push_back(a[0] + (b[0] - a[0]) * (y - a[1]) / (b[1] - a[1]));
    }
  }
  std::sort(places.begin(), places.end());
  return places;
}

}  // namespace

std::vector<double> rasterize(const std::vector<MapPolygon>& polygons, const MapGrid& grid) {
  std::vector<double> values(grid.count(), 0.0);
  for (const auto& polygon : polygons) {
    for (int row = 0; row < grid.rows; ++row) {
      // Even-odd: between the first and the second crossing is inside, holes count out.
      const auto places = crossings(polygon, grid.y(row));
      for (std::size_t k = 0; k + 1 < places.size(); k += 2) {
        const double first = std::ceil((places[k] - grid.west) / grid.cell - 0.5);
        const double past = std::ceil((places[k + 1] - grid.west) / grid.cell - 0.5);
        const int from = static_cast<int>(std::clamp(first, 0.0, static_cast<double>(grid.columns)));
        const int to = static_cast<int>(std::clamp(past, 0.0, static_cast<double>(grid.columns)));
        for (int column = from; column < to; ++column) values[grid.index(column, row)] = 1;
      }
    }
  }
  return values;
}

std::optional<Survey> read_survey(const SurveyOptions& options, const RunMaps& maps, double footprint_threshold) {
  if (!options.given()) return std::nullopt;
  Survey survey;
  survey.name = options.name;
  if (!options.thickness.empty()) {
    auto thickness = read_thickness(options.thickness, options, maps);
    survey.grid = thickness.grid;
    survey.deposit = std::move(thickness.values);
    survey.inputs.push_back(options.thickness);
  } else if (!options.after_dem.empty()) {
    read_change(options, maps, footprint_threshold, survey);
  }
  read_footprint(options, maps, footprint_threshold, survey);
  check_overlap(survey.inputs.front(), survey, maps);
  return survey;
}

OnSurveyGrid bring_to_survey_grid(const RunMaps& maps, const Survey& survey) {
  const auto bring = [&](const std::vector<double>& values) { return on_grid({maps.grid, values}, survey.grid); };
  OnSurveyGrid simulated{bring(maps.deposit_thickness), bring(maps.peak_thickness), 0};
  auto initial = survey.deposit_is_change ? bring(maps.initial_thickness) : std::vector<double>(survey.grid.count(), 0.0);
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
    if (survey.deposit_is_change) h = std::max(0.0, h - (std::isnan(initial[i]) ? 0 : initial[i]));
    if (std::isfinite(surveyed[i])) continue;
    simulated.deposit_left_out += h * area;
    h = std::numeric_limits<double>::quiet_NaN();
  }
  return simulated;
}

}  // namespace talus::postprocess
