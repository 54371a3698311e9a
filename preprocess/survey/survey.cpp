// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/survey.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "common/error.hpp"
#include "common/gis/features.hpp"
#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "preprocess/regions/polygon_cover.hpp"
#include "preprocess/survey/shifted_parts.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr double noticeable_shift = 0.2;    // cells
constexpr double well_known = 0.1;          // cells: a shift whose standard error is larger is warned of
constexpr double noticeable_height = 0.05;  // [m]

/// The polygons of what changed: named ones, source and deposit.
std::vector<MapPolygon> changed_ground(const Survey& s, const std::filesystem::path& named) {
  std::vector<MapPolygon> all;
  if (!named.empty()) all = read_polygons(named, s.grid.crs_wkt, "changed");
  all.insert(all.end(), s.source.begin(), s.source.end());
  all.insert(all.end(), s.deposit.begin(), s.deposit.end());
  return all;
}

/// Ground whose change is not looked at has no height.
void leave_out(std::vector<Patch>& patches, const std::vector<MapPolygon>& ignored) {
  if (ignored.empty()) return;
  for (Patch& patch : patches) {
    const std::vector<char> inside = cells_inside(ignored, patch.before.grid);
    for (std::size_t i = 0; i < inside.size(); ++i)
      if (inside[i]) patch.before.values[i] = nan;
  }
}

/// The overlap of both in cells of the first, whatever part of it and spacing the scene is computed with.
MapGrid whole_overlap(const Elevation& before, const Elevation& after, const Options& options) {
  const double spacing = before.scattered ? options.grid.spacing : 0;
  MapGrid grid = working_grid({&before, &after}, {.crs = options.working_crs, .spacing = spacing});
  constexpr double longest = 1e8, most = 1e11;  // cells: at some 10 million a second a night's work
  const double cells = static_cast<double>(grid.columns) * grid.rows;
  if (grid.columns > longest || grid.rows > longest || cells > most)
    throw DataError({fmt::format("{} and {} share {} x {} cells", before.file.string(), after.file.string(),
                                 grid.columns, grid.rows),
                     fmt::format("surveys of up to {:g} cells, {:g} along a side, are compared", most, longest),
                     "Cut the slide and its surroundings out of both (gdal_translate -projwin)"});
  return grid;
}

[[noreturn]] void refuse_alignment(const Survey& s, std::size_t shared) {
  throw DataError(
      {fmt::format("{}: no stable ground to align it on ({} cells are shared with {})", s.after.file.string(),
                   grouped(static_cast<double>(shared)), s.before.file.string()),
       fmt::format(
           "{} cells are needed that are neither steep nor rough nor part of the slide, and more of them than changed",
           least_cells),
       "Give elevation models that reach further beyond the slide, name the changed ground in "
       "[preprocess.coregistration], or align the models beforehand and set mode = \"off\""});
}

double largest_shift_error(const Survey& s) { return std::max(s.fit.shift_error[0], s.fit.shift_error[1]); }

bool noticeable(const Survey& s) {
  const Placement& p = s.fit.placement;
  const double told = std::max(noticeable_shift * s.grid.cell, 2 * largest_shift_error(s));
  return std::hypot(p.x, p.y) > told || std::abs(p.z) > std::max(noticeable_height, s.fit.aligned.nmad) ||
         p.tilt_x != 0 || p.tilt_y != 0;
}

std::string placement_words(const Survey& s) {
  const Placement& p = s.fit.placement;
  const auto& [east, north] = s.fit.shift_error;
  const double cell = s.grid.cell;
  std::string words = fmt::format(
      "{:+.2f} +- {:.2f} m east, {:+.2f} +- {:.2f} m north ({:+.3f} +- {:.3f}, {:+.3f} +- {:.3f} cells), {:+.2f} m "
      "high",
      -p.x, east, -p.y, north, -p.x / cell, east / cell, -p.y / cell, north / cell, -p.z);
  if (p.tilt_x != 0 || p.tilt_y != 0)
    words += fmt::format(", tilted by {:+.2f} m/km towards the east and {:+.2f} m/km towards the north",
                         -1000 * p.tilt_x, -1000 * p.tilt_y);
  return words;
}

/// A cell of shift on a slope is a cell times its rise of height: what is not known of one is not known of the other.
void warn_of_vague_shift(const Survey& s) {
  const double error = largest_shift_error(s);
  if (!(error > well_known * s.grid.cell)) return;
  warn("vague-shift",
       fmt::format("{}: its shift on the map is known to {:.2f} m (standard error), {:.2f} cells, only: on a slope of "
                   "30 degrees "
                   "heights differ by {:.2f} m for that alone. Give elevation models with more stable ground beyond "
                   "the slide, with "
                   "finer cells or with less noise, or align them beforehand and set mode = \"off\" in "
                   "[preprocess.coregistration]",
                   s.after.file.string(), error, error / s.grid.cell, error * std::tan(std::numbers::pi / 6)),
       {{"shift_error", error, "m"}});
}

/// What is compared with itself shows no error; that is no sign that it has none.
void warn_of_unknown_error(const Survey& s) {
  constexpr double noticeable_share = 0.1;
  const double same = s.errors.same_share();
  const std::string mend = "Give what the surveys themselves are good for: sigma_m in [preprocess.difference]";
  if (!s.errors.is_known()) {
    warn("unknown-survey-error",
         fmt::format("{}: the error of its difference from {} is not known ({}): no error is stated, and changes "
                     "count from threshold_m on. {}",
                     s.after.file.string(), s.before.file.string(),
                     s.fit.known ? fmt::format("they are the same to 1 mm on {:.0f} % of stable ground, so one "
                                               "was made from the other",
                                               100 * same)
                                 : "there is too little stable ground to learn it from",
                     mend),
         {{"same_share", same, "1"}});
  } else if (!s.errors.is_given() && same > noticeable_share) {
    warn("surveys-partly-equal",
         fmt::format("{} is the same as {} to 1 mm on {:.0f} % of stable ground: part of it was not surveyed "
                     "twice, and the error learnt there is too small. {}",
                     s.after.file.string(), s.before.file.string(), 100 * same, mend),
         {{"same_share", same, "1"}});
  }
}

void say_alignment(const Survey& s) {
  if (!s.fit.known) {
    log_info(
        fmt::format("{}: too little ground shared with {} is stable to tell how they lie on one another, or how large "
                    "their error is",
                    s.after.file.string(), s.before.file.string()));
    return;
  }
  const std::string where = fmt::format("{}: on stable ground it lies {} of {}", s.after.file.string(),
                                        placement_words(s), s.before.file.string());
  if (s.applied)
    log_info(where + "; corrected");
  else if (noticeable(s))
    warn("surveys-not-aligned", where + ". Correct it: mode = \"apply\" in [preprocess.coregistration]");
  warn_of_vague_shift(s);
}

using Json = nlohmann::ordered_json;

Json json_of(const Residuals& r) {
  return {{"cells", r.count},
          {"median_m", r.median},
          {"nmad_m", r.nmad},
          {"rmse_m", r.rmse},
          {"median_absolute_m", r.median_absolute}};
}

/// An error that is not known (NaN) is written as null.
Json json_of(const VolumeWithError& v) { return {{"volume_m3", v.volume}, {"error_m3", v.error}, {"area_m2", v.area}}; }

Json json_of(const Budget& b) {
  return {{"erosion", json_of(b.erosion)}, {"deposition", json_of(b.deposition)}, {"net", json_of(b.net)}};
}

/// How the later survey lay, not how it was moved: a shift to the east reads as one.
Json alignment_of(const Survey& s) {
  if (!s.fit.known) return {{"known", false}};
  const Placement& p = s.fit.placement;
  return {{"known", true},
          {"applied", s.applied},
          {"after_lies_east_m", -p.x},
          {"after_lies_north_m", -p.y},
          {"after_lies_east_error_m", s.fit.shift_error[0]},
          {"after_lies_north_error_m", s.fit.shift_error[1]},
          {"after_lies_error_cells", std::max(s.fit.shift_error[0], s.fit.shift_error[1]) / s.grid.cell},
          {"after_lies_high_m", -p.z},
          {"after_tilts_east_m_per_km", -1000 * p.tilt_x},
          {"after_tilts_north_m_per_km", -1000 * p.tilt_y},
          {"horizontal_shift_known", s.fit.shift_known},
          {"iterations", s.fit.iterations},
          {"converged", s.fit.converged},
          {"stable_share", s.fit.stable_share},
          {"stable_ground_as_it_came", json_of(s.fit.unaligned)},
          {"stable_ground_aligned", json_of(s.fit.aligned)}};
}

Json error_of(const Survey& s) {
  const Variogram& v = s.errors.variogram();
  Json json{{"known", s.errors.is_known()}, {"same_share", s.errors.same_share()}};
  if (!s.errors.is_known()) return json;
  json["cell_m"] = s.errors.typical();
  json["given"] = s.errors.is_given();
  json["mean_height_m"] = s.errors.offset();
  for (int deg = 0; deg <= 60; deg += 10)
    json["by_slope_m"][std::to_string(deg) + "_deg"] = s.errors.sigma(std::tan(deg * 0.017453292519943295));
  json["variogram"] = {{"nugget", v.nugget},
                       {"short_sill", v.short_sill},
                       {"short_range_m", v.short_range},
                       {"long_sill", v.long_sill},
                       {"long_range_m", v.long_range},
                       {"lags_m", v.lags},
                       {"semivariance", v.semivariance}};
  json["level_of_detection_m"] = level_of_detection(s.errors.sigma(0));
  return json;
}

Json outside_of(const SurveyedSlide& slide) {
  const ChangeOutside& o = slide.outside;
  return {{"rise_m3", o.rise},
          {"fall_m3", o.fall},
          {"sure_rise_m3", o.sure_rise},
          {"sure_fall_m3", o.sure_fall},
          {"largest_region_m3", o.largest},
          {"large", slide.outside_is_large},
          {"noise_within_reach_rise_m3", slide.near.rise},
          {"noise_within_reach_fall_m3", slide.near.fall},
          {"doubtful", slide.outside_is_doubtful},
          {"words", outside_words(slide)}};
}

}  // namespace

Survey compare_surveys(Elevation before, Elevation after, const Options& options) {
  const CoregistrationOptions& how = options.coregistration;
  Survey s;
  s.before = std::move(before);
  s.after = std::move(after);
  s.grid = whole_overlap(s.before, s.after, options);
  if (!options.source.polygon.empty())
    s.source = read_united_polygons(options.source.polygon, s.grid.crs_wkt, options.source.grow, "source");
  if (!options.deposit.polygon.empty())
    s.deposit = read_valid_polygons(options.deposit.polygon, s.grid.crs_wkt, "deposit");
  if (!options.difference.ignore.empty())
    s.ignored = read_valid_polygons(options.difference.ignore, s.grid.crs_wkt, "ignore");
  const double given = options.difference.sigma;
  s.errors = ErrorModel::of(given);
  std::vector<Patch> patches = patches_of(s.before, s.after, s.grid);
  leave_out(patches, s.ignored);
  if (how.mode == Alignment::off && given > 0) {
    judge_shifted_parts(patches, {}, s.after.file);
    return s;
  }
  find_stable(patches, changed_ground(s, how.changed));
  s.fit = coregister(patches, true, s.after.file);
  judge_shifted_parts(patches, s.fit.known ? s.fit.placement : Placement{}, s.after.file);
  if (!s.fit.known && how.mode == Alignment::apply) refuse_alignment(s, s.grid.count());
  s.applied = how.mode == Alignment::apply;
  if (how.mode != Alignment::off) say_alignment(s);
  if (!s.fit.known) {
    warn_of_unknown_error(s);
    return s;
  }
  if (s.applied) {
    s.after.placement = s.fit.placement;
    s.grid = whole_overlap(s.before, s.after, options);
  }
  s.errors = ErrorModel::learnt(patches, s.applied ? s.fit.placement : Placement{}, given);
  warn_of_unknown_error(s);
  for (Patch& patch : patches) s.stable.emplace_back(patch.before.grid, std::move(patch.stable));
  return s;
}

std::vector<std::string> as_lines(const Survey& s) {
  if (!s.fit.known) return {};
  const Residuals &was = s.fit.unaligned, &is = s.applied ? s.fit.aligned : s.fit.unaligned;
  std::vector<std::string> lines{fmt::format("stable ground: {} cells, {:.0f} % of what both surveys hold",
                                             grouped(static_cast<double>(is.count)), 100 * s.fit.stable_share)};
  if (s.applied)
    lines.push_back(fmt::format(
        "after - before there: median {:+.3f} -> {:+.3f} m, NMAD {:.3f} -> {:.3f} m, median |dz| {:.3f} -> {:.3f} m",
        was.median, is.median, was.nmad, is.nmad, was.median_absolute, is.median_absolute));
  else
    lines.push_back(fmt::format("after - before there: median {:+.3f} m, NMAD {:.3f} m", is.median, is.nmad));
  if (!s.errors.is_known()) {
    lines.push_back("error of the difference: not known");
    return lines;
  }
  const Variogram& v = s.errors.variogram();
  std::string line = fmt::format("error of the difference: {:.3f} m a cell{}; {:.0f} % of its variance independent",
                                 s.errors.typical(),
                                 s.errors.is_given()                           ? " (given)"
                                 : s.errors.sigma(1) > 1.1 * s.errors.sigma(0) ? " (more on steep ground)"
                                                                               : "",
                                 100 * v.nugget);
  for (const auto& [sill, range] : {std::pair{v.short_sill, v.short_range}, {v.long_sill, v.long_range}})
    if (sill > 0) line += fmt::format(", {:.0f} % alike over {:.0f} m", 100 * sill, range);
  lines.push_back(line);
  return lines;
}

SurveyedSlide slide_on(const Survey& s, const Raster& before, const std::vector<Filled>& filled) {
  SurveyedSlide slide{{before.grid, {}}, {before.grid, {}}, {before.grid, {}}, {}, {before.grid, {}}, {}};
  slide.sigma.values = s.errors.sigmas(before);
  if (!s.ignored.empty()) slide.ignored = cells_inside(s.ignored, before.grid);
  for (std::size_t k = 0; k < filled.size(); ++k) {
    if (filled[k].count() == 0) continue;
    slide.filled.values.resize(before.grid.count(), 0.0);
    slide.fill_error.resize(before.grid.count(), 0.0);
    const double unknown = std::isnan(filled[k].rmse())
                               ? 0.0
                               : filled[k].rmse();  // where a hole found no place to be tried: as the others
    for (std::size_t i = 0; i < slide.sigma.values.size(); ++i) {
      if (!filled[k].filled[i]) continue;
      const double error = std::isnan(filled[k].sigma[i]) ? unknown : filled[k].sigma[i];
      slide.sigma.values[i] = std::hypot(slide.sigma.values[i], error);
      slide.fill_error[i] = std::hypot(slide.fill_error[i], error);
      slide.filled.values[i] += static_cast<double>(k + 1);
    }
  }
  return slide;
}

std::vector<double> levels_of(const Raster& sigma) {
  std::vector<double> levels;
  for (const double value : sigma.values) levels.push_back(level_of_detection(value));
  return levels;
}

std::string survey_json(const Survey& s, const Budgets& budgets, const std::optional<SurveyedSlide>& slide,
                        const Facts& marks) {
  Json json{{"before", s.before.file.string()},
            {"after", s.after.file.string()},
            {"cell_m", s.grid.cell},
            {"columns", s.grid.columns},
            {"rows", s.grid.rows},
            {"id", fact(marks, domain_id)},
            {"recipe", fact(marks, recipe_of_domain)}};
  json["alignment"] = alignment_of(s);
  json["error"] = error_of(s);
  json["volumes"] = {{"raw", json_of(budgets.raw)}, {"beyond_level_of_detection", json_of(budgets.thresholded)}};
  if (slide) {
    for (const SurveyedVolume& side : slide->volumes) json[side.name] = json_of(side.volume);
    json["outside_slide"] = outside_of(*slide);
  }
  json["findings"] = Json::parse(to_json(findings_so_far()));
  return json.dump(2) + "\n";
}

}  // namespace talus::preprocess
