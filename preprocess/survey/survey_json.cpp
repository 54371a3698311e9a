// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/survey/survey_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "common/stage/findings.hpp"
namespace talus::preprocess {

namespace {

using Json = nlohmann::ordered_json;

Json json_of(const Residuals& r) {
  return {{"cells", r.count},
          {"median_m", r.median},
          {"nmad_m", r.nmad},
          {"rmse_m", r.rmse},
          {"median_absolute_m", r.median_absolute}};
}

/// A number, null where it is not known.
Json number_or_null(double value) { return std::isnan(value) ? Json(nullptr) : Json(value); }

Json json_of(const VolumeWithError& v) {
  return {{"volume_m3", v.volume}, {"error_m3", number_or_null(v.error)}, {"area_m2", v.area}};
}

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

Json json_of(const ChangeOutside& o) {
  return {{"rise_m3", o.rise},
          {"fall_m3", o.fall},
          {"sure_rise_m3", o.sure_rise},
          {"sure_fall_m3", o.sure_fall},
          {"largest_region_m3", o.largest}};
}

}  // namespace

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
    json["outside_slide"] = json_of(slide->outside);
    json["outside_slide"]["large"] = slide->outside_is_large;
    json["outside_slide"]["noise_within_reach_rise_m3"] = slide->near.rise;
    json["outside_slide"]["noise_within_reach_fall_m3"] = slide->near.fall;
    json["outside_slide"]["doubtful"] = slide->outside_is_doubtful;
    json["outside_slide"]["words"] = outside_words(*slide);
  }
  json["findings"] = Json::parse(to_json(findings_so_far()));
  return json.dump(2) + "\n";
}

}  // namespace talus::preprocess
