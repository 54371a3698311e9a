// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of the report's map.
#include <cmath>

#include "common/map/isolines.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/picture/layers.hpp"
#include "postprocess/report/pack.hpp"
#include "postprocess/report/parts.hpp"

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
    if (!survey.polygons.empty())
      json["survey_footprint"] = lines_json(rings(survey.polygons), window);
    else if (!survey.footprint.empty())
      json["survey_footprint"] = outline(survey.grid, survey.footprint, survey.footprint_threshold, window);
  }
  if (input.hazard != nullptr) add_hazard_lines(json, input, window);
  json["thalweg"] = line_json(input.thalweg.line, window);
  json["contours"] = contours(maps, window);
  return json;
}

}  // namespace talus::postprocess
