// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/options/hazard.hpp"

#include <algorithm>
#include <functional>
#include <utility>

#include <fmt/format.h>

namespace talus::postprocess {

void IntensityOptions::describe(recipe::Visitor& v) {
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
    v.needs(limits->empty() || limits->size() == classes,
            {fmt::format("[postprocess.intensity] {} has {} limits, another quantity {}", key, limits->size(), classes),
             "every quantity says where each class begins", "Give as many limits for each"});
    v.needs(std::adjacent_find(limits->begin(), limits->end(), std::greater_equal<>()) == limits->end(),
            {fmt::format("[postprocess.intensity] {} does not rise", key), "classes are given by their lower limits",
             "Sort the limits, each once"});
    v.needs(limits->size() <= 9, {fmt::format("[postprocess.intensity] {} has {} classes", key, limits->size()),
                                  "nobody tells more than 9 shades apart on a map", "Give 9 limits or fewer"});
  }
}

void ReachConeOptions::describe(recipe::Visitor& v) {
  v.optional_number("angle_deg", angle, recipe::Range{0, 90, true, true},
                    "angle of reach (Fahrboeschung) of maps/reach_cone.tif, below the horizontal");
  v.flag("by_volume", by_volume,
         "cones by the angles usual for the released volume as well (Scheidegger 1973, Corominas 1996)");
}

void BuildingOptions::describe(recipe::Visitor& v) {
  v.path("polygons", polygons,
         "footprints of buildings (any vector format): what comes to each, into buildings.csv and maps/buildings.gpkg");
  v.number("pressure_coefficient", pressure_coefficient, recipe::positive,
           "thrust over density times speed squared (1: Hungr et al. 1984)");
  v.text("attribute", attribute,
         "the polygons' attribute that holds their height above the ground [m], if they have it");
}

}  // namespace talus::postprocess
