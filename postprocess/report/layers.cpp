// The grids the report's map shows, with their classes.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"
#include "postprocess/fields/styles.hpp"
#include "postprocess/picture/hillshade.hpp"
#include "postprocess/report/limits.hpp"
#include "postprocess/report/pack.hpp"
#include "postprocess/report/parts.hpp"

namespace talus::postprocess {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
// What a map may hold before its cells are merged: pages stay below some ten megabytes.
constexpr std::size_t cells_of_a_map = 300'000, cells_of_all_frames = 9'000'000;

double largest(const std::vector<double>& values) {
  double top = 0;
  for (const double v : values)
    if (v > top) top = v;
  return top;
}

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
  Merge merge = Merge::largest;
  int decimals = 1;
  std::string about{};
};

class Layers {
 public:
  Layers(const ReportInput& input, const Window& window, int& coarsest)
      : input_(input), maps_(input.run.maps), window_(window), coarsest_(coarsest) {}

  Json build() {
    simulated();
    erosion();
    if (input_.survey) surveyed(*input_.survey);
    return std::move(list_);
  }

 private:
  void add(Layer layer) {
    auto raster = cut(layer.raster, window_);
    const int factor = factor_for(raster.grid, cells_of_a_map);
    coarsest_ = std::max(coarsest_, factor);
    raster = coarsened(raster, factor, layer.merge);
    list_.push_back({{"id", layer.id},
                     {"title", layer.title},
                     {"unit", layer.unit},
                     {"decimals", layer.decimals},
                     {"about", layer.about},
                     {"codes", layer.id == "agreement"},
                     {"classes", layer.classes},
                     {"grid", grid_json(raster.grid)},
                     {"data", packed(raster.values)}});
  }

  Raster map(const std::vector<double>& values) const { return values_raster(maps_, values, true); }
  Json thickness_classes(const std::vector<double>& values, Ramp ramp = Ramp::heat) const {
    return classes(thickness_limits(input_.options.classes, values), ramp);
  }

  void simulated();
  void erosion();
  void surveyed(const Survey& survey);
  void difference(const Survey& survey, const OnSurveyGrid& simulated);
  void agreement(const Survey& survey, const OnSurveyGrid& simulated);

  const ReportInput& input_;
  const RunMaps& maps_;
  const Window& window_;
  int& coarsest_;
  Json list_ = Json::array();
};

void Layers::simulated() {
  const auto deposit = thickness_classes(maps_.deposit_thickness);
  add({"deposit", "Deposit thickness", "m", deposit, map(maps_.deposit_thickness), Merge::mean, 2,
       "Thickness at the end of the run, vertical."});
  add({"peak_thickness", "Peak thickness", "m", thickness_classes(maps_.peak_thickness), map(maps_.peak_thickness),
       Merge::largest, 2, "Largest thickness over time, vertical."});
  const auto threshold = fmt::format(", where the flow was thicker than {:g} m.", maps_.threshold);
  add({"peak_speed", "Peak speed", "m/s", classes(speed_limits(maps_), Ramp::sea), map(maps_.peak_speed),
       Merge::largest, 1, "Largest depth-mean speed over time" + threshold});
  add({"peak_pressure", "Peak pressure", "kPa", classes(pressure_limits(maps_), Ramp::heat), map(maps_.peak_pressure),
       Merge::largest, 1, "Largest density times speed squared over time" + threshold});
  add({"arrival", "Arrival time", "s", time_classes(time_limits(maps_)),
       values_raster(maps_, maps_.arrival_time, false), Merge::smallest, 1,
       fmt::format("When the flow first was thicker than {:g} m.", maps_.threshold)});
  add({"release", "Release thickness", "m", thickness_classes(maps_.initial_thickness), map(maps_.initial_thickness),
       Merge::mean, 2, "Thickness at the start, vertical."});
  for (const auto& [name, values] : maps_.deposit_of)
    add({"deposit_" + file_word(name), "Deposit from " + name, "m", deposit, map(values), Merge::mean, 2,
         "The part of the deposit that came from this release, vertical."});
}

void Layers::erosion() {
  if (maps_.eroded_depth.empty()) return;
  add({"eroded", "Eroded depth", "m", thickness_classes(maps_.eroded_depth, Ramp::sea), map(maps_.eroded_depth),
       Merge::mean, 2, "Depth of the ground that went along, vertical."});
}

void Layers::surveyed(const Survey& survey) {
  const auto simulated = bring_to_survey_grid(maps_, survey);
  if (!survey.deposit.empty()) {
    add({"surveyed",
         "Deposit, " + survey.name,
         "m",
         thickness_classes(maps_.deposit_thickness),
         {survey.grid, survey.deposit},
         Merge::mean,
         2,
         survey.deposit_is_change ? "Rise of the surface between the two surveys, vertical." : "Thickness, vertical."});
    difference(survey, simulated);
  }
  if (!survey.footprint.empty()) agreement(survey, simulated);
}

void Layers::difference(const Survey& survey, const OnSurveyGrid& simulated) {
  const double limit = input_.options.deposit_threshold;
  Raster raster{survey.grid, std::vector<double>(survey.grid.count(), nan)};
  for (std::size_t i = 0; i < raster.values.size(); ++i)
    if (simulated.deposit[i] > limit || survey.deposit[i] > limit)
      raster.values[i] = simulated.deposit[i] - survey.deposit[i];
  const auto limits = difference_limits(raster.values);
  add({"difference", "Difference, simulated \u2212 " + survey.name, "m", difference_classes(limits), std::move(raster),
       Merge::mean, 2,
       fmt::format("Where either deposit is thicker than {:g} m: red where the simulation has more, blue where it has "
                   "less.",
                   limit)});
}

void Layers::agreement(const Survey& survey, const OnSurveyGrid& simulated) {
  Raster raster{survey.grid, std::vector<double>(survey.grid.count(), nan)};
  for (std::size_t i = 0; i < raster.values.size(); ++i) {
    const bool here = simulated.peak[i] > input_.options.footprint_threshold;
    const bool there = survey.footprint[i] > survey.footprint_threshold;
    if (std::isnan(survey.footprint[i]) || !(here || there)) continue;
    raster.values[i] = here && there ? both : here ? simulation_only : survey_only;
  }
  add({"agreement", "Footprint agreement", "", agreement_classes(survey.name), std::move(raster), Merge::largest, 0,
       fmt::format("Footprint: peak thickness above {:g} m. The score counts these areas.",
                   input_.options.footprint_threshold)});
}

}  // namespace

Json layers_json(const ReportInput& input, const Window& window, int& coarsest) {
  return Layers(input, window, coarsest).build();
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
        coarsened(cut(values_raster(run.maps, flow_thickness(run, i), true), window), factor, Merge::mean);
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

Json ground_json(const ReportInput& input, const Window& window, int& coarsest) {
  const auto& maps = input.run.maps;
  const auto ground = cut({maps.grid, maps.before}, window);
  const int factor = factor_for(ground.grid, cells_of_a_map);
  coarsest = std::max(coarsest, factor);
  const auto elevation = coarsened(ground, factor, Merge::mean);
  return {{"grid", grid_json(elevation.grid)},
          {"elevation", packed(elevation.values)},
          {"shade", packed(hillshade(elevation.grid, elevation.values))}};
}

}  // namespace talus::postprocess
