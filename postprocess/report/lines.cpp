// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of the report: on the map, along the thalweg, over time.
#include <cmath>

#include "common/map/polygon.hpp"
#include "common/run/mobility.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/picture/picture.hpp"
#include "postprocess/report/report.hpp"

namespace talus::postprocess {
namespace {

/// Outline of what exceeds `level` on a grid of its own.
Json outline(const MapGrid& grid, const std::vector<double>& values, double level, const Window& window) {
  return lines_json(isolines(grid, values, level, AtEdge::close), window);
}

Json contours(const RunMaps& maps, const Window& window) {
  const ContourLevels levels = contour_levels({window, {}}, maps);
  Json json{{"interval", levels.interval}, {"levels", Json::array()}};
  for (long k = levels.first; k <= levels.last; ++k) {
    const double level = static_cast<double>(k) * levels.interval;
    auto lines = lines_json(isolines(maps.grid, maps.before, level, AtEdge::end), window);
    if (!lines.empty())
      json["levels"].push_back({{"level", level}, {"index", k % 5 == 0}, {"lines", std::move(lines)}});
  }
  return json;
}

/// The line around what an angle of reach reaches, footprints of buildings and obstacles.
void add_hazard_lines(Json& json, const ReportInput& input, const Window& window) {
  const Hazard& hazard = *input.hazard;
  std::vector<MapPolygon> buildings;
  for (const Building& building : hazard.buildings)
    buildings.insert(buildings.end(), building.parts.begin(), building.parts.end());
  if (!hazard.cones.empty())
    json["reach"] = outline(input.run.maps.grid, reached_cells(hazard.cones.front()), 0.5, window);
  if (!buildings.empty()) json["buildings"] = lines_json(rings(buildings), window);
}

std::vector<double> zero_for_nan(std::vector<double> values) {
  for (double& v : values) v = std::isnan(v) ? 0 : v;
  return values;
}

std::vector<double> sum(std::vector<double> a, const std::vector<double>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) a[i] += b[i];
  return a;
}

/// To centimetres: a profile needs no more, and pages stay small.
Json rounded(const std::vector<double>& values) {
  auto list = Json::array();
  for (const double v : values) list.push_back(std::isfinite(v) ? Json(std::round(100 * v) / 100) : Json());
  return list;
}

/// Surveyed surface after the event along the line: before + change, or bed + thickness.
std::vector<double> surveyed_surface(const ReportInput& input, const Thalweg& thalweg) {
  const auto& survey = *input.survey;
  const auto& maps = input.run.maps;
  auto change = survey.deposit;
  if (survey.deposit_is_change && survey.footprint_is_change) {
    for (std::size_t i = 0; i < change.size(); ++i)
      if (!(change[i] > 0)) change[i] = -survey.footprint[i];  // where it did not rise, |change| is how far it sank
  }
  const auto& foot = survey.deposit_is_change ? maps.before : maps.terrain;
  return sum(sample_along(thalweg, maps.grid, foot), sample_along(thalweg, survey.grid, change));
}

/// Volume in motion and its mean speed over time: from the history, which has a row for every record; of older runs,
/// whose history has neither, from the points at the frames.
Json motion_json(const ReportInput& input) {
  const RunHistory& history = input.run.history;
  const HistoryColumn *time = history.find("time_s"), *volume = history.find("moving_volume_m3"),
                      *speed = history.find("moving_speed_m_s");
  if (time != nullptr && volume != nullptr && speed != nullptr && time->values.size() >= 2)
    return {{"time", time->values},
            {"volume", rounded(volume->values)},
            {"mean_speed", rounded(speed->values)},
            {"from_history", true},
            {"faster_than", moving_faster_than}};
  const auto motion = read_motion(input.run_file, moving_faster_than);
  if (motion.time.size() < 2) return nullptr;
  return {{"time", motion.time},
          {"volume", rounded(motion.volume)},
          {"mean_speed", rounded(motion.mean_speed)},
          {"from_history", false},
          {"faster_than", moving_faster_than}};
}

}  // namespace

Json lines_json(const ReportInput& input, const Window& window) {
  const auto maps = cropped(input.run.maps, window);
  const auto& options = input.options;
  Json json;
  json["release"] = outline(maps.grid, maps.initial_thickness, options.deposit_threshold, window);
  json["footprint"] = outline(maps.grid, maps.peak_thickness, options.footprint_threshold, window);
  if (input.survey) {
    const auto& survey = *input.survey;
    if (!survey.deposit.empty())
      json["survey_deposit"] = outline(survey.grid, survey.deposit, options.deposit_threshold, window);
    if (!survey.polygons.empty() || !survey.footprint.empty())
      json["survey_footprint"] = lines_json(footprint_lines(survey), window);
  }
  if (input.hazard != nullptr) add_hazard_lines(json, input, window);
  json["thalweg"] = line_json(input.thalweg.line, window);
  json["contours"] = contours(maps, window);
  return json;
}

Json profile_json(const ReportInput& input) {
  const auto& thalweg = input.thalweg;
  if (thalweg.line.size() < 2) return nullptr;
  const auto& maps = input.run.maps;
  const auto along = [&](const std::vector<double>& values) { return sample_along(thalweg, maps.grid, values); };
  const auto bed = along(maps.terrain);
  const auto deposit = along(zero_for_nan(maps.deposit_thickness)), peak = along(zero_for_nan(maps.peak_thickness));
  Json json{{"given", thalweg.given},
            {"origin", thalweg.origin},
            {"distance", rounded(thalweg.distance)},
            {"before", rounded(along(maps.before))},
            {"bed", rounded(bed)},
            {"deposit_surface", rounded(sum(bed, deposit))},
            {"deposit", rounded(deposit)},
            {"peak", rounded(peak)},
            {"speed", rounded(along(zero_for_nan(maps.peak_speed)))}};
  if (input.survey && !input.survey->deposit.empty()) {
    json["surveyed_surface"] = rounded(surveyed_surface(input, thalweg));
    json["surveyed"] = rounded(sample_along(thalweg, input.survey->grid, input.survey->deposit));
  }
  return json;
}

Json series_json(const ReportInput& input) {
  const auto& thalweg = input.thalweg;
  const auto& history = input.run.history;
  Json json{{"history", Json::object()}, {"at_places", Json::array()}, {"front", nullptr}, {"motion", nullptr}};
  for (const HistoryColumn& column : history.columns) {
    json["history"][column.name] = column.values;
    if (column.place.empty()) continue;
    json["at_places"].push_back(
        {{"name", column.name}, {"unit", column.unit}, {"quantity", column.quantity}, {"place", column.place}});
  }
  if (thalweg.line.size() >= 2) {
    const auto front = front_by_arrival(input.run.maps, thalweg, thalweg.length() / 400);
    if (front.time.size() >= 2)
      json["front"] = {{"time", front.time},
                       {"distance", rounded(front.value)},
                       {"until", input.run.summary.time_end},
                       {"threshold", input.run.maps.threshold}};
  }
  json["motion"] = motion_json(input);
  return json;
}

}  // namespace talus::postprocess
