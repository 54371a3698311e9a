// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The grids the report's map shows, with their classes.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/report/report.hpp"

namespace talus::postprocess {
namespace {

// What a map may hold before its cells are merged: pages stay below some ten megabytes.
constexpr std::size_t cells_of_a_map = 300'000, cells_of_all_frames = 9'000'000;

/// A class: values from `from` up to `to`, null without end.
Json class_json(double from, double to, const Colour& colour, const std::string& label) {
  return {{"from", from}, {"to", to}, {"colour", hex(colour)}, {"label", label}};
}

constexpr double endless = std::numeric_limits<double>::infinity();

Json classes(const std::vector<double>& limits, Ramp ramp) {
  auto list = Json::array();
  for (std::size_t i = 0; i < limits.size(); ++i)
    list.push_back(class_json(limits[i], i + 1 < limits.size() ? limits[i + 1] : endless,
                              class_colour(i, limits.size(), ramp), class_label(i, limits)));
  return list;
}

/// Early is dark: what comes first matters most.
Json time_classes(const std::vector<double>& limits) {
  auto list = Json::array();
  const std::size_t count = limits.size() + 1;
  for (std::size_t i = 0; i < count; ++i) {
    const auto label = limits.empty() ? std::string("all")
                       : i == 0       ? fmt::format("0 \u2013 {:g}", limits[0])
                                      : class_label(i - 1, limits);
    list.push_back(class_json(i == 0 ? -endless : limits[i - 1], i < limits.size() ? limits[i] : endless,
                              class_colour(count - 1 - i, count, Ramp::sea), label));
  }
  return list;
}

Json difference_classes(const std::vector<double>& limits) {
  auto list = Json::array();
  const auto count = limits.size();
  for (std::size_t i = count; i-- > 0;) {
    const double next = i + 1 < count ? -limits[i + 1] : -endless;
    list.push_back(class_json(next, -limits[i], difference_colour(false, i, count),
                              i + 1 < count ? fmt::format("\u2212{:g} \u2013 \u2212{:g}", limits[i + 1], limits[i])
                                            : fmt::format("< \u2212{:g}", limits[i])));
  }
  list.push_back(class_json(-limits[0], limits[0], {0.95, 0.95, 0.93}, fmt::format("within \u00b1{:g}", limits[0])));
  for (std::size_t i = 0; i < count; ++i)
    list.push_back(class_json(limits[i], i + 1 < count ? limits[i + 1] : endless, difference_colour(true, i, count),
                              (i + 1 < count ? "+" : "") + class_label(i, limits)));
  return list;
}

/// Codes of the agreement map.
enum Agreement { both = 1, simulation_only = 2, survey_only = 3 };

Json agreement_classes(const std::string& survey) {
  return {class_json(0.5, 1.5, {0.53, 0.55, 0.58}, "both"),
          class_json(1.5, 2.5, difference_colour(true, 1, 3), "simulation only"),
          class_json(2.5, 3.5, difference_colour(false, 1, 3), survey + " only")};
}

struct Layer {
  std::string id, title, unit;
  Json classes;
  Raster raster;
  MergedCells merge = MergedCells::largest;
  int decimals = 1;
  std::string about{};
};

/// 1, 2 or 5 times a power of ten that is at least `value`.
double round_above(double value) {
  const double power = std::pow(10, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0})
    if (step * power >= value * (1 - 1e-12)) return step * power;
  return 10 * power;
}

struct Layers {
  const ReportInput& input;
  const Window& window;
  int& coarsest;
  const RunMaps& maps = input.run.maps;
  Json list = Json::array();

  Json build() {
    simulated();
    if (input.hazard != nullptr) of_hazard(*input.hazard);
    if (input.survey) surveyed(*input.survey);
    return std::move(list);
  }

  void add(Layer layer) {
    auto raster = cut(layer.raster, window);
    const int factor = factor_for(raster.grid, cells_of_a_map);
    coarsest = std::max(coarsest, factor);
    raster = coarsened(raster, factor, layer.merge);
    list.push_back({{"id", layer.id},
                    {"title", layer.title},
                    {"unit", layer.unit},
                    {"decimals", layer.decimals},
                    {"about", layer.about},
                    {"codes", layer.id == "agreement" || layer.id == "intensity"},
                    {"classes", layer.classes},
                    {"grid", grid_json(raster.grid)},
                    {"data", packed(raster.values)}});
  }

  Json thickness_classes(const std::vector<double>& values) const {
    return classes(thickness_limits(input.options.classes, values), Ramp::heat);
  }

  void simulated() {
    for (const MapField& field : map_fields)
      if (!field.optional) of_run(field);
    const auto deposit = thickness_classes(maps.deposit_thickness);
    const std::vector<std::string> words = file_words(maps.deposit_of);
    for (std::size_t r = 0; r < words.size(); ++r) {
      const auto& [name, values] = maps.deposit_of[r];
      add({"deposit_" + words[r], "Deposit from " + name, "m", deposit, values_raster(maps, values, true),
           MergedCells::mean, 2, "The part of the deposit that came from this release, vertical."});
    }
    for (const MapField& field : map_fields)
      if (field.optional) of_run(field);
  }

  void of_hazard(const Hazard& hazard) {
    if (const auto& map = hazard.intensity) {
      auto shades = Json::array();
      for (const IntensityClass& one : map->classes)
        shades.push_back(class_json(one.code - 0.5, one.code + 0.5, one.colour, one.name + ": " + one.words));
      add({"intensity",
           "Intensity, " + map->guideline,
           "",
           std::move(shades),
           {maps.grid, map->codes},
           MergedCells::largest,
           0,
           "Classes by " + map->source + "."});
    }
    if (hazard.cones.empty()) return;
    const ReachCone& cone = hazard.cones.front();
    add({"reach",
         "Height of the energy line",
         "m",
         classes(thickness_limits({}, cone.head), Ramp::sea),
         {maps.grid, cone.head},
         MergedCells::largest,
         1,
         fmt::format("Above the ground, of a line that falls by H/L = {:.2f} from the release.", cone.tangent)});
  }

  void of_run(const MapField& field) {
    const MapLayer& layer = field.layer;
    if (layer.id[0] == '\0' || (maps.*(field.values)).empty()) return;
    const auto limits = map_limits(field, maps, input.options.classes);
    const bool time = field.product.classes == MapClasses::time;
    add({layer.id, layer.title, layer.unit, time ? time_classes(limits) : classes(limits, layer.ramp),
         field_raster(maps, field), layer.merge, layer.decimals,
         fmt::format(fmt::runtime(layer.about), maps.threshold)});
  }

  void surveyed(const Survey& survey) {
    const auto simulated = bring_to_survey_grid(maps, survey, input.options);
    if (!survey.deposit.empty()) {
      add({"surveyed",
           "Deposit, " + survey.name,
           "m",
           thickness_classes(maps.deposit_thickness),
           {survey.grid, survey.deposit},
           MergedCells::mean,
           2,
           survey.deposit_is_change ? "Rise of the surface between the two surveys, vertical."
                                    : "Thickness, vertical."});
      difference(survey, simulated);
    }
    if (!survey.footprint.empty()) agreement(survey, simulated);
  }

  void difference(const Survey& survey, const OnSurveyGrid& simulated) {
    const double limit = input.options.deposit_threshold;
    Raster raster{survey.grid, std::vector<double>(survey.grid.count(), nan)};
    for (std::size_t i = 0; i < raster.values.size(); ++i)
      if (simulated.deposit[i] > limit || survey.deposit[i] > limit)
        raster.values[i] = simulated.deposit[i] - survey.deposit[i];
    const auto limits = difference_limits(raster.values);
    add({"difference", "Difference, simulated \u2212 " + survey.name, "m", difference_classes(limits),
         std::move(raster), MergedCells::mean, 2,
         fmt::format(
             "Where either deposit is thicker than {:g} m: red where the simulation has more, blue where it has "
             "less.",
             limit)});
  }

  void agreement(const Survey& survey, const OnSurveyGrid& simulated) {
    Raster raster{survey.grid, std::vector<double>(survey.grid.count(), nan)};
    for (std::size_t i = 0; i < raster.values.size(); ++i) {
      const bool here = simulated.touched[i] > most_of_a_cell;
      const bool there = survey.footprint[i] > survey.footprint_threshold;
      if (std::isnan(survey.footprint[i]) || !(here || there)) continue;
      raster.values[i] = here && there ? both : here ? simulation_only : survey_only;
    }
    add({"agreement", "Footprint agreement", "", agreement_classes(survey.name), std::move(raster),
         MergedCells::largest, 0,
         fmt::format("Footprint: peak thickness above {:g} m. The score counts these areas.",
                     input.options.footprint_threshold)});
  }
};

}  // namespace

Json layers_json(const ReportInput& input, const Window& window, int& coarsest) {
  return Layers{input, window, coarsest}.build();
}

Json frames_json(const ReportInput& input, const Window& window, int& coarsest) {
  const auto& run = input.run;
  Json json{{"time", Json::array()}};
  std::vector<std::vector<double>> frames;
  MapGrid grid = cut({run.maps.grid, run.maps.before}, window).grid;
  const auto count = std::max<std::size_t>(run.frames.time.size(), 1);
  const int factor = factor_for(grid, std::min(cells_of_a_map, cells_of_all_frames / count));
  coarsest = std::max(coarsest, factor);
  double thickest = 0;
  for (std::size_t i = 0; i < run.frames.time.size(); ++i) {
    const auto frame =
        coarsened(cut(values_raster(run.maps, flow_thickness(run, i), true), window), factor, MergedCells::mean);
    grid = frame.grid;
    json["time"].push_back(run.frames.time[i]);
    thickest = std::max(thickest, largest(frame.values));
    frames.push_back(frame.values);
  }
  json["classes"] = classes(thickness_limits(input.options.classes, {thickest}), Ramp::heat);
  json["grid"] = grid_json(grid);
  json["data"] = packed(frames);
  return json;
}

Raster shown_ground(const ReportInput& input, const Window& window, int& coarsest) {
  const auto ground = cut({input.run.maps.grid, input.run.maps.before}, window);
  const int factor = factor_for(ground.grid, cells_of_a_map);
  coarsest = std::max(coarsest, factor);
  return coarsened(ground, factor, MergedCells::mean);
}

std::vector<double> difference_limits(const std::vector<double>& differences) {
  std::vector<double> sizes;
  for (const double d : differences)
    if (std::abs(d) > 0) sizes.push_back(std::abs(d));
  if (sizes.empty()) return {0.2, 0.5, 1};
  const auto place = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() - 1 - sizes.size() / 10);
  std::nth_element(sizes.begin(), place, sizes.end());
  const double scale = round_above(std::max(*place, 0.1));
  return {scale / 5, scale / 2, scale};
}

}  // namespace talus::postprocess
