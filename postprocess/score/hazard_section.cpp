// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the maps say to an authority: areas by intensity, the second opinion of a cone, buildings.
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/score/sections.hpp"

namespace talus::postprocess {
namespace {

void intensities(const IntensityMap& map, Sheet& sheet) {
  sheet.section("Intensity");
  sheet.text("intensity_guideline", "classes by", map.guideline + ": " + map.source);
  for (const IntensityClass& one : map.classes)
    sheet.number(fmt::format("intensity_{}_area_m2", one.code), one.name + " (" + one.words + ")", "m2", one.area, 0);
}

void cones(const std::vector<ReachCone>& found, Sheet& sheet) {
  sheet.section("Angle of reach, a second opinion");
  for (const ReachCone& cone : found) {
    const bool own = cone.name == "angle_deg";
    const std::string key = "reach_" + (own ? "given" : file_word(cone.name)), name = own ? "given angle" : cone.name;
    sheet.number(key + "_angle_deg", name, "deg", std::atan(cone.tangent) * 180 / std::numbers::pi, 1);
    sheet.number(key + "_area_m2", name + ": area reached", "m2", cone.area, 0);
    sheet.number(key + "_covers_footprint", name + ": share of the simulated footprint within", "", cone.covered, 3,
                 "there is no footprint");
  }
}

void buildings(const std::vector<Building>& all, Sheet& sheet) {
  sheet.section("Buildings");
  std::int64_t reached = 0;
  double force = 0;
  for (const Building& b : all) {
    if (b.thickness.largest > 0) ++reached;
    force = std::max(force, b.force);
  }
  sheet.count("buildings", "buildings and obstacles", static_cast<std::int64_t>(all.size()));
  sheet.count("buildings_reached", "of them reached", reached);
  sheet.number("max_building_force_N", "largest thrust on one of them", "N", force, 0);
}

}  // namespace

void add_hazard(const Hazard& hazard, Sheet& sheet) {
  if (hazard.intensity) intensities(*hazard.intensity, sheet);
  if (!hazard.cones.empty()) cones(hazard.cones, sheet);
  if (!hazard.buildings.empty()) buildings(hazard.buildings, sheet);
}

}  // namespace talus::postprocess
