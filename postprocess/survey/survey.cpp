// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/survey/survey.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "common/gis/crs.hpp"
#include "common/gis/features.hpp"
#include "common/gis/raster_file.hpp"
#include "common/gis/resampling.hpp"
#include "common/map/raster.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/files.hpp"
#include "common/stage/findings.hpp"

namespace talus::postprocess {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::json;

std::filesystem::path file_in(const std::filesystem::path& out) { return out / "survey" / "survey.json"; }

/// The file, null where there is none, discarded where it is no JSON.
Json read_json(const std::filesystem::path& out) {
  const std::optional<std::string> text = text_if_there(file_in(out));
  return text ? Json::parse(*text, nullptr, false) : Json(nullptr);
}

Json table(const Json& in, const char* key) {
  return in.is_object() && in.contains(key) && in.at(key).is_object() ? in.at(key) : Json::object();
}

bool flag(const Json& in, const char* key, bool otherwise) {
  return in.contains(key) && in.at(key).is_boolean() ? in.at(key).get<bool>() : otherwise;
}

std::string word_in(const Json& in, const char* key) {
  return in.contains(key) && in.at(key).is_string() ? in.at(key).get<std::string>() : "";
}

bool error_known(const Json& json) { return flag(table(json, "error"), "known", true); }

/// Throws DataError, with the command that mends it, unless the file's CRS is the run's.
void check_crs(const std::filesystem::path& file, const MapGrid& grid, const MapGrid& run) {
  if (same_crs(grid.crs_wkt, run.crs_wkt)) return;
  const auto mend = run.crs_wkt.empty() || grid.crs_wkt.empty()
                        ? fmt::format("If the coordinates fit, name the CRS: gdal_edit.py -a_srs {} {}",
                                      run.crs_wkt.empty() ? "None" : crs_name(run.crs_wkt), file.string())
                        : fmt::format("Reproject: gdalwarp -t_srs {} {} out.tif", crs_name(run.crs_wkt), file.string());
  throw DataError({fmt::format("{}: CRS is {}", file.string(), crs_name(grid.crs_wkt)),
                   fmt::format("the run is in {}", crs_name(run.crs_wkt)), mend});
}

/// Values that the options call normal to the slope become vertical ones, by the slope of the run's ground.
void to_vertical(Raster& raster, const SurveyOptions& options, const RunMaps& maps) {
  if (options.direction != Direction::slope_normal) return;
  const auto cosine = on_grid({maps.grid, slope_cosine({maps.grid, maps.terrain})}, raster.grid);
  for (std::size_t i = 0; i < cosine.size(); ++i)
    if (cosine[i] > 0) raster.values[i] /= cosine[i];  // beyond the run's ground: as it is
}

std::string box(const MapGrid& grid) {
  return fmt::format("x {:.1f} to {:.1f}, y {:.1f} to {:.1f}", grid.west, grid.east(), grid.south, grid.north());
}

void check_overlap(const fs::path& file, const Survey& survey, const RunMaps& maps) {
  const auto& values = survey.deposit.empty() ? survey.footprint : survey.deposit;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto [column, row] = survey.grid.cell_of(i);
    const double x = survey.grid.x(column), y = survey.grid.y(row);
    if (x > maps.grid.west && x < maps.grid.east() && y >= maps.grid.south && y <= maps.grid.north() &&
        std::isfinite(values[i]))
      return;
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

/// after - before on the grid of the after DEM, or on the run's where that DEM has another CRS. `ground`: heights of
/// the run's surface.
void read_surfaces(const SurveyOptions& options, const RunMaps& maps, const DeclaredHeights& ground, Survey& survey) {
  const RasterFile file = raster_in_metres(options.after_dem, maps.grid.crs_wkt);
  Raster after = file.read();
  survey.inputs.push_back(options.after_dem);
  if (after.grid.crs_wkt.empty() != maps.grid.crs_wkt.empty()) check_crs(options.after_dem, after.grid, maps.grid);
  if (!same_crs(after.grid.crs_wkt, maps.grid.crs_wkt)) after = resample_elevation(after, maps.grid);
  Raster before{maps.grid, maps.before};
  if (!options.before_dem.empty()) {
    const RasterFile earlier = raster_in_metres(options.before_dem, maps.grid.crs_wkt);
    before = earlier.read();
    judge_vertical_datums(earlier.heights(), file.heights());
    survey.inputs.push_back(options.before_dem);
  } else {
    judge_vertical_datums(ground, file.heights());
  }
  if (!same_grid(before.grid, after.grid) || !same_crs(before.grid.crs_wkt, after.grid.crs_wkt))
    before = resample_elevation(before, after.grid);
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

/// No survey is free of error: 0 is what comes out where one model was made from the other.
void refuse_zeros(const std::filesystem::path& file, const Raster& sigma) {
  if (std::any_of(sigma.values.begin(), sigma.values.end(), [](double s) { return s > 0; })) return;
  throw DataError({file.string() + ": a standard error of 0 m everywhere", "no survey is free of error",
                   "Give its true error (sigma_m), or leave sigma out: no score carries an error then"});
}

/// The raster of sigma on the survey's grid. A measured value without a sigma, or with one of 0, is not known well
/// enough to be compared; a measured 0 stands for ground that was mapped as untouched, and needs none.
std::vector<double> read_sigma(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  if (options.sigma.empty()) return std::vector<double>(survey.grid.count(), options.sigma_m);
  auto raster = read_raster(options.sigma);
  check_crs(options.sigma, raster.grid, maps.grid);
  survey.inputs.push_back(options.sigma);
  if (!options.thickness.empty()) to_vertical(raster, options, maps);
  if (!same_grid(raster.grid, survey.grid)) raster = resample_elevation(raster, survey.grid);
  refuse_zeros(options.sigma, raster);
  std::size_t without = 0;
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    double& sigma = raster.values[i];
    if (sigma < 0)
      throw DataError({fmt::format("{}: a standard error of {:g} m", options.sigma.string(), sigma),
                       "it cannot be negative", "Give the raster of 1 sigma, in metres"});
    if (sigma > 0 || std::isnan(survey.measured[i])) continue;
    if (survey.measured[i] == 0) {
      sigma = 0;
      continue;
    }
    survey.measured[i] = nan;
    ++without;
  }
  if (without > 0) survey.notes.push_back(fmt::format("{} surveyed cells without a sigma are left out.", without));
  return raster.values;
}

/// Fills survey.error as the options say; measured values without a sigma become NaN, and a note says how many. Warns
/// where the range of the errors is not known. Throws DataError: unreadable file, other CRS, negative sigma.
void read_error(const SurveyOptions& options, const RunMaps& maps, Survey& survey) {
  if (options.sigma.empty() && options.sigma_m == 0) return;
  auto& error = survey.error;
  error.sigma = read_sigma(options, maps, survey);
  error.detection = 1.96;  // 95 %
  error.correlation_length = options.correlation_length;
  if (options.correlation_length == 0 && !options.sigma.empty())
    error.correlation_length = std::max(0.0, raster_item(options.sigma, "CORRELATION_LENGTH_M").value_or(0));
  if (error.correlation_length > 0) return;
  warn("unknown-correlation-length",
       "[postprocess.survey] The range of the survey's errors is not known: they are drawn for every cell for itself, "
       "which makes the spread of scores too small. Give correlation_length_m.");
}

}  // namespace

FoundSurvey read_found_survey(const std::filesystem::path& out) {
  if (fs::exists(out / "survey" / "slide_difference.tif") && !fs::exists(file_in(out)))
    throw DataError({file_in(out).string() + ": no such file",
                     "talus-preprocess writes it last; without it what lies beside it may be of two preparations",
                     "Run talus-preprocess again"});
  const Json json = read_json(out);
  if (json.is_null()) return {};
  if (!json.is_object())
    throw DataError(
        {file_in(out).string() + ": it is no JSON", "it was cut short or edited", "Run talus-preprocess again"});
  const Json outside = table(json, "outside_slide");
  return {error_known(json),         flag(outside, "large", false), flag(outside, "doubtful", false),
          word_in(outside, "words"), word_in(json, "id"),           word_in(json, "recipe")};
}

bool lacks_error(const std::filesystem::path& out) { return !error_known(read_json(out)); }

void judge_outside(const FoundSurvey& found, const std::filesystem::path& out) {
  if (!found.outside_is_large) return;
  refuse_unless_accepted("change-outside-slide",
                         {file_in(out).string() + ": " + found.outside_words,
                          "the surveyed deposit, and every score against it, would lack what belongs to the slide",
                          "Look at survey/survey.qgs, set these keys, and run talus-preprocess again"});
}

bool same_grid(const MapGrid& a, const MapGrid& b) {
  const double slack = 1e-6 * a.cell;
  return a.columns == b.columns && a.rows == b.rows && std::abs(a.west - b.west) < slack &&
         std::abs(a.south - b.south) < slack && std::abs(a.cell - b.cell) * std::max(a.columns, a.rows) < slack;
}

std::vector<double> on_grid(const Raster& raster, const MapGrid& grid) {
  return same_grid(raster.grid, grid) ? raster.values : resample_thickness(raster, grid).values;
}

void judge_order(const Survey& survey, const RunMaps& maps) {
  if (!survey.deposit_is_change) return;
  constexpr double tells = 0.1;  // of what fell: less that rose has no say in where mass went
  const Raster run_ground{maps.grid, maps.before};
  const Raster ground = same_grid(maps.grid, survey.grid) ? run_ground : resample_elevation(run_ground, survey.grid);
  std::array<Sum, 2> volume, moment;
  for (std::size_t i = 0; i < survey.measured.size(); ++i) {
    const double change = survey.measured[i], height = ground.values[i];
    const double least = std::max(survey.footprint_threshold, survey.error.level(i));
    if (!(std::abs(change) > least) || std::isnan(height)) continue;
    const std::size_t side = change > 0;
    volume.at(side).add(std::abs(change));
    moment.at(side).add(std::abs(change) * height);
  }
  const double fall = volume[0].value(), rise = volume[1].value(), area = survey.grid.cell * survey.grid.cell;
  if (!(fall > 0) || !(rise > tells * fall)) return;
  const double higher = moment[1].value() / rise - moment[0].value() / fall;
  if (!(higher > 0)) return;
  refuse_unless_accepted(
      "swapped-surveys",
      {fmt::format("[postprocess.survey]: {} m3 rose and {} m3 fell", grouped(rise * area), grouped(fall * area)),
       fmt::format("what rose lies {:.1f} m higher than what fell, and mass goes down", higher),
       "Are before_dem and after_dem swapped, or is the difference before less after? Then turn them round"},
      {{"rise", rise * area, "m3"}, {"fall", fall * area, "m3"}, {"higher", higher, "m"}});
}

std::optional<Survey> read_survey(const SurveyOptions& options, const RunMaps& maps, double footprint_threshold,
                                  const DeclaredHeights& ground) {
  if (!options.given()) return std::nullopt;
  Survey survey;
  survey.name = options.name;
  survey.kind = options.kind;
  if (!options.after_dem.empty()) {
    read_surfaces(options, maps, ground, survey);
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
    if (survey.error.sigma.empty() && survey.kind == ReferenceKind::survey) survey.error.noise = noise_of(survey, maps);
    auto seen = detected(survey, survey.measured);
    survey.deposit = std::move(seen.deposit);
    if (survey.footprint_is_change) survey.footprint = std::move(seen.footprint);
    survey.footprint_threshold = footprint_threshold;
  }
  read_footprint(options, maps, footprint_threshold, survey);
  check_overlap(survey.inputs.front(), survey, maps);
  return survey;
}

namespace {

/// The share of each cell of `grid` in which values exceed a threshold; 0 where the map ends.
std::vector<double> share_above(const MapGrid& from, std::vector<double> values, double threshold, const MapGrid& to) {
  for (double& v : values) v = v > threshold ? 1 : 0;
  std::vector<double> share = on_grid({from, std::move(values)}, to);
  for (double& v : share)
    if (!(v > 0)) v = 0;
  return share;
}

/// What the surface of the run stood at before a change, beyond the ground: what was released and taken along [m].
std::vector<double> before_change(const RunMaps& maps, const MapGrid& grid) {
  std::vector<double> initial = on_grid({maps.grid, maps.initial_thickness}, grid);
  for (double& h : initial) h = std::isnan(h) ? 0 : h;
  if (maps.eroded_depth.empty()) return initial;
  const auto eroded = on_grid({maps.grid, maps.eroded_depth}, grid);
  for (std::size_t i = 0; i < eroded.size(); ++i)
    if (std::isfinite(eroded[i])) initial[i] += eroded[i];
  return initial;
}

}  // namespace

OnSurveyGrid bring_to_survey_grid(const RunMaps& maps, const Survey& survey, const Options& options) {
  const auto bring = [&](const std::vector<double>& values) { return on_grid({maps.grid, values}, survey.grid); };
  OnSurveyGrid simulated;
  simulated.deposit = bring(maps.deposit_thickness);
  simulated.peak = bring(maps.peak_thickness);
  simulated.touched = share_above(maps.grid, maps.peak_thickness, options.footprint_threshold, survey.grid);
  simulated.covered = share_above(maps.grid, maps.deposit_thickness, options.deposit_threshold, survey.grid);
  const auto initial =
      survey.deposit_is_change ? before_change(maps, survey.grid) : std::vector<double>(survey.grid.count(), 0.0);
  const auto& surveyed = survey.deposit.empty() ? survey.footprint : survey.deposit;
  const double area = survey.grid.cell * survey.grid.cell;
  for (std::size_t i = 0; i < surveyed.size(); ++i) {
    double& h = simulated.deposit[i];
    double& peak = simulated.peak[i];
    h = std::isnan(h) ? 0 : h;
    peak = std::isnan(peak) ? 0 : peak;
    const double change = h - initial[i];
    if (survey.deposit_is_change) h = std::max(0.0, change);
    simulated.change.push_back(survey.deposit_is_change ? change : h);
    if (!std::isfinite(surveyed[i])) {
      simulated.deposit_left_out += h * area;
      h = simulated.change.back() = nan;
      continue;
    }
    const double level = survey.deposit.empty() ? 0 : survey.error.level(i);
    if (h < level) h = 0;
    if (survey.footprint_is_change && peak < level) peak = 0;
    if (survey.deposit_is_change) simulated.covered[i] = h > options.deposit_threshold ? 1 : 0;
    if (h == 0) simulated.covered[i] = 0;
    if (peak == 0) simulated.touched[i] = 0;
  }
  return simulated;
}

double Survey::usual_level() const {
  std::vector<double> levels;
  for (std::size_t i = 0; i < measured.size(); ++i)
    if (!std::isnan(measured[i]) && !std::isnan(error.level(i))) levels.push_back(error.level(i));
  return levels.empty() ? 0 : median(levels);
}

double noise_of(const Survey& survey, const RunMaps& maps) {
  constexpr double normal = 5 * 1.4826, most = 1;
  std::vector<double> moved = maps.peak_thickness;
  for (std::size_t i = 0; i < moved.size(); ++i)
    if (maps.initial_thickness[i] > moved[i]) moved[i] = maps.initial_thickness[i];
  const std::vector<double> thickness = on_grid({maps.grid, moved}, survey.grid);
  std::vector<double> left_alone;
  std::size_t surveyed = 0;
  for (std::size_t i = 0; i < thickness.size(); ++i) {
    if (std::isnan(survey.measured[i])) continue;
    ++surveyed;
    if (!(thickness[i] > 0))
      left_alone.push_back(survey.deposit_is_change ? -std::abs(survey.measured[i]) : survey.measured[i]);
  }
  if (2 * left_alone.size() < surveyed || left_alone.empty()) return 0;
  const double usual = survey.deposit_is_change ? 0.5 : 0.25;
  return std::clamp(-normal * quantile(std::move(left_alone), usual), 0.0, most);
}

DetectedChange detected(const Survey& survey, const std::vector<double>& value) {
  DetectedChange seen{value, value};
  const auto& error = survey.error;
  for (std::size_t i = 0; i < value.size(); ++i) {
    const bool detected = !(std::abs(value[i]) < error.level(i));
    if (std::isnan(value[i])) continue;
    seen.deposit[i] = detected ? std::max(0.0, value[i]) : 0;
    seen.footprint[i] = detected ? std::abs(value[i]) : 0;
  }
  return seen;
}

}  // namespace talus::postprocess
