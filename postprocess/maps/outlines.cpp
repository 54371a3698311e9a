// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/maps/gis.hpp"

#include <algorithm>
#include <string>

#include <fmt/format.h>

#include "postprocess/fields/styles.hpp"

namespace talus::postprocess {
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

}  // namespace

std::vector<OutlineLayer> map_outlines(const Run& run, const Options& options, const std::optional<Survey>& survey) {
  const auto& maps = run.maps;
  std::vector<OutlineLayer> layers;
  layers.push_back(
      {"footprint", {above({maps.grid, maps.peak_thickness}, "peak thickness", options.footprint_threshold, "m")}});
  layers.push_back(deposit_layer(run, options));
  layers.push_back(pressure_layer(run));
  layers.push_back(
      {"release", {above({maps.grid, maps.initial_thickness}, "release", options.deposit_threshold, "m")}});
  if (!maps.critical_thickness.empty())
    layers.push_back(
        {"critical", {above({maps.grid, maps.critical_thickness}, "critical mass", options.deposit_threshold, "m")}});
  if (survey) layers.push_back(survey_layer(*survey, options));
  return layers;
}

}  // namespace talus::postprocess
