// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an authority asks of the maps: classes of intensity, a cone of reach, numbers by building.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::postprocess {

/// By whose limits intensity is told apart (postprocess/hazard/intensity.hpp).
enum class Guideline {
  none,
  swiss_debris_flow,
  swiss_flood,
  swiss_avalanche,
  debris_flow_concrete,
  debris_flow_other,
  own
};

/// Whether one of the quantities is enough for a class, or all are needed.
enum class Rule { any, all };

/// The keys of [postprocess.intensity].
struct IntensityOptions {
  Guideline guideline = Guideline::none;
  std::vector<double> thickness{}, speed{}, thickness_speed{}, pressure{};  ///< own limits [m], [m/s], [m2/s], [kPa]
  Rule rule = Rule::any;
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v) {
    recipe::choice(v, "guideline", guideline,
                   {{"none", Guideline::none},
                    {"swiss-debris-flow", Guideline::swiss_debris_flow},
                    {"swiss-flood", Guideline::swiss_flood},
                    {"swiss-avalanche", Guideline::swiss_avalanche},
                    {"debris-flow-concrete", Guideline::debris_flow_concrete},
                    {"debris-flow-other", Guideline::debris_flow_other},
                    {"own", Guideline::own}},
                   "whose limits make the classes of maps/intensity.tif; own: those below; none: no such map");
    v.numbers("thickness_m", thickness, recipe::positive,
              "own: peak thickness from which class 1, 2, ... begins; any of the quantities given is enough");
    v.numbers("speed_m_s", speed, recipe::positive, "own: the same of the peak speed");
    v.numbers("pressure_kPa", pressure, recipe::positive, "own: the same of the peak pressure");
    const std::pair<const char*, const std::vector<double>*> given[] = {
        {"thickness_m", &thickness}, {"speed_m_s", &speed}, {"pressure_kPa", &pressure}};
    std::size_t classes = 0;
    for (const auto& [key, limits] : given) classes = std::max(classes, limits->size());
    v.needs(guideline == Guideline::own || classes == 0,
            {"[postprocess.intensity] gives limits, but guideline is not \"own\"", "a guideline brings its own limits",
             "Leave them out, or take guideline = \"own\""});
    v.needs(guideline != Guideline::own || classes > 0,
            {"[postprocess.intensity] guideline = \"own\" without limits", "there would be no class",
             "Give thickness_m, speed_m_s or pressure_kPa"});
    for (const auto& [key, limits] : given) {
      v.needs(
          limits->empty() || limits->size() == classes,
          {fmt::format("[postprocess.intensity] {} has {} limits, another quantity {}", key, limits->size(), classes),
           "every quantity says where each class begins", "Give as many limits for each"});
      v.needs(std::adjacent_find(limits->begin(), limits->end(), std::greater_equal<>()) == limits->end(),
              {fmt::format("[postprocess.intensity] {} does not rise", key), "classes are given by their lower limits",
               "Sort the limits, each once"});
      v.needs(limits->size() <= 9, {fmt::format("[postprocess.intensity] {} has {} classes", key, limits->size()),
                                    "nobody tells more than 9 shades apart on a map", "Give 9 limits or fewer"});
    }
  }
};

/// The keys of [postprocess.reach_cone].
struct ReachConeOptions {
  std::optional<double> angle{};  ///< of the cone below the horizontal [deg]
  bool by_volume = false;         ///< cones by the published regressions of H/L over volume too
  /// Whether a cone is asked for.
  bool asked() const { return angle || by_volume; }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
    v.optional_number("angle_deg", angle, recipe::Range{0, 90, true, true},
                      "angle of reach (Fahrboeschung) of maps/reach_cone.tif, below the horizontal");
    v.flag("by_volume", by_volume,
           "cones by the angles usual for the released volume as well (Scheidegger 1973, Corominas 1996)");
  }
};

/// The keys of [postprocess.buildings].
struct BuildingOptions {
  std::filesystem::path polygons{};
  double pressure_coefficient = 1;   ///< of the thrust over density times speed squared [-]
  std::string attribute = "height";  ///< of the polygons: height above the ground [m]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
    v.path(
        "polygons", polygons,
        "footprints of buildings (any vector format): what comes to each, into buildings.csv and maps/buildings.gpkg");
    v.number("pressure_coefficient", pressure_coefficient, recipe::positive,
             "thrust over density times speed squared (1: Hungr et al. 1984)");
    v.text("attribute", attribute,
           "the polygons' attribute that holds their height above the ground [m], if they have it");
  }
};

/// By which map the intensity of a hazard goes.
enum class HazardIntensity { peak_pressure, peak_thickness, peak_speed };

/// Classes by how probable it is that a place is hit at least so hard (of an ensemble).
struct HazardOptions {
  HazardIntensity intensity = HazardIntensity::peak_pressure;
  std::vector<double> limits;                       // lower limits of its classes, rising; empty = the usual ones
  std::vector<double> probability{0.01, 0.1, 0.5};  // lower limits of its classes, rising
  std::vector<int> matrix{1, 1, 2, 1, 2, 3};        // class, row by row: intensity from weak, probability from rare

  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v) {
    recipe::choice(v, "intensity", intensity,
                   {{"peak-pressure", HazardIntensity::peak_pressure},
                    {"peak-thickness", HazardIntensity::peak_thickness},
                    {"peak-speed", HazardIntensity::peak_speed}},
                   "the map by which the intensity of a hazard goes");
    v.numbers("limits", limits, recipe::positive,
              "lower limits of the classes of intensity, rising, in kPa, m or m/s; they must be among those of "
              "[ensemble.thresholds]; empty: 3 30 kPa, 0.5 1 m, 0.5 1 m/s where they are");
    v.numbers("probability", probability, recipe::fraction, "lower limits of the classes of probability, rising");
    v.integers("matrix", matrix, {0, 9},
               "hazard class of each intensity (from weak) and probability (from rare), row by row; 0: none");
    const auto rises = [](const std::vector<double>& values) {
      return std::adjacent_find(values.begin(), values.end(), std::greater_equal<>()) == values.end();
    };
    v.needs(rises(limits) && rises(probability) && !probability.empty(),
            {"[postprocess.hazard] limits or probability do not rise", "classes are given by their lower limits",
             "Sort them, each once"});
    const std::size_t rows = limits.empty() ? 2 : limits.size();
    v.needs(matrix.size() == rows * probability.size(),
            {"[postprocess.hazard] matrix has " + std::to_string(matrix.size()) + " classes",
             std::to_string(rows) + " intensities and " + std::to_string(probability.size()) + " probabilities take " +
                 std::to_string(rows * probability.size()),
             "Give a class for each pair"});
  }
};

}  // namespace talus::postprocess
