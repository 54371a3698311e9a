#include "postprocess/score/survey.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "common/raster/slope.hpp"
#include "common/stage/stage.hpp"

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

/// Slope-normal values to vertical ones, where the options say so and the run has ground.
void to_vertical(Raster& raster, const SurveyOptions& options, const RunMaps& maps) {
  if (options.direction != Direction::slope_normal) return;
  const auto cosine = on_grid({maps.grid, slope_cosine({maps.grid, maps.terrain})}, raster.grid);
  for (std::size_t i = 0; i < cosine.size(); ++i) {
    if (cosine[i] > 0) raster.values[i] /= cosine[i];  // beyond the run's ground: as it is
  }
}

Raster read_values(const fs::path& file, const SurveyOptions& options, const RunMaps& maps) {
  auto raster = read_raster(file);
  check_crs(file, raster.grid, maps.grid);
  if (options.nodata_is_zero) zero_for_nodata(raster.values);
  return raster;
}

Raster read_thickness(const fs::path& file, const SurveyOptions& options, const RunMaps& maps) {
  auto raster = read_values(file, options, maps);
  to_vertical(raster, options, maps);
  return raster;
}

/// after - before on the grid of the after DEM, or on the run's where that DEM has another CRS.
void read_surfaces(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  auto after = read_raster(options.after_dem);
  survey.inputs.push_back(options.after_dem);
  if (after.grid.crs_wkt.empty() != maps.grid.crs_wkt.empty()) check_crs(options.after_dem, after.grid, maps.grid);
  if (!same_crs(after.grid.crs_wkt, maps.grid.crs_wkt)) after = resample_elevation(after, maps.grid);
  Raster before{maps.grid, maps.before};
  if (!options.before_dem.empty()) {
    before = read_raster(options.before_dem);
    survey.inputs.push_back(options.before_dem);
  }
  if (!same_grid(before.grid, after.grid) || !same_crs(before.grid.crs_wkt, after.grid.crs_wkt)) {
    before = resample_elevation(before, after.grid);
  }
  survey.grid = after.grid;
  for (std::size_t i = 0; i < after.values.size(); ++i) survey.measured.push_back(after.values[i] - before.values[i]);
}

/// The raster of sigma on the survey's grid. A measured value without a sigma is not known well enough to be compared; 0
/// stands for ground that was mapped as untouched, and needs none.
std::vector<double> read_sigma(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  if (options.sigma.empty()) return std::vector<double>(survey.grid.count(), options.sigma_m);
  auto raster = read_raster(options.sigma);
  check_crs(options.sigma, raster.grid, maps.grid);
  survey.inputs.push_back(options.sigma);
  if (!options.thickness.empty()) to_vertical(raster, options, maps);
  if (!same_grid(raster.grid, survey.grid)) raster = resample_elevation(raster, survey.grid);
  std::size_t without = 0;
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    double& sigma = raster.values[i];
    if (sigma < 0)
      throw DataError({fmt::format("{}: a standard error of {:g} m", options.sigma.string(), sigma), "it cannot be negative",
                       "Give the raster of 1 sigma, in metres"});
    if (!std::isnan(sigma) || std::isnan(survey.measured[i])) continue;
    if (survey.measured[i] == 0) {
      sigma = 0;
      continue;
    }
    survey.measured[i] = std::numeric_limits<double>::quiet_NaN();
    ++without;
  }
  if (without > 0) survey.notes.push_back(fmt::format("{} surveyed cells without a sigma are left out.", without));
  return raster.values;
}

void read_error(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  if (options.sigma.empty() && options.sigma_m == 0) return;
  auto& error = survey.error;
  error.sigma = read_sigma(options, maps, survey);
  error.detection = options.detection;
  error.correlation_length = options.correlation_length;
  if (options.correlation_length == 0 && !options.sigma.empty())
    error.correlation_length = std::max(0.0, raster_item(options.sigma, "CORRELATION_LENGTH_M").value_or(0));
  if (error.correlation_length > 0 || options.resamples == 0) return;
  const std::string warning =
      "The range of the survey's errors is not known: they are drawn for every cell for itself, which makes the spread of "
      "scores too small. Give correlation_length_m.";
  survey.notes.push_back("Warning: " + warning);
  log_warning("[postprocess.survey] " + warning);
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

Sighting sight(const Survey& survey, const std::vector<double>& value) {
  Sighting seen{value, value};
  const auto& error = survey.error;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool detected = error.sigma.empty() || !(std::abs(value[i]) < error.detection * error.sigma[i]);
    if (std::isnan(value[i])) continue;
    seen.deposit[i] = detected ? std::max(0.0, value[i]) : 0;
    seen.footprint[i] = detected ? std::abs(value[i]) : 0;
  }
  return seen;
}

std::optional<Survey> read_survey(const SurveyOptions& options, const RunMaps& maps, double footprint_threshold) {
  if (!options.given()) return std::nullopt;
  Survey survey;
  survey.name = options.name;
  if (!options.after_dem.empty()) {
    read_surfaces(options, maps, survey);
  } else if (options.measures()) {
    const auto& file = options.thickness.empty() ? options.difference : options.thickness;
    auto raster = options.thickness.empty() ? read_values(file, options, maps) : read_thickness(file, options, maps);
    survey.grid = raster.grid;
    survey.measured = std::move(raster.values);
    survey.inputs.push_back(file);
  }
  if (options.measures()) {
    survey.deposit_is_change = survey.footprint_is_change = options.thickness.empty();
    read_error(options, maps, survey);
    auto seen = sight(survey, survey.measured);
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
