// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How far the mass went: straight, along the thalweg, and by its centre.
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "postprocess/score/sections.hpp"

namespace talus::postprocess {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

void straight(const Scored& scored, Sheet& sheet) {
  const auto& maps = scored.run.maps;
  const auto& crown = scored.crown;
  const auto toe =
      crown ? farthest(maps.grid, maps.deposit_thickness, scored.options.deposit_threshold, *crown, maps.before)
            : std::nullopt;
  if (!toe)
    return sheet.skip({"runout_m", "drop_m", "h_over_l", "fahrboeschung_deg", "max_drop_m"},
                      crown ? "no deposit above the threshold" : "no release in the run's maps");
  const double length = plan_distance(*crown, *toe), drop = crown->z - toe->z;
  double lowest = nan;
  for (std::size_t i = 0; i < maps.before.size(); ++i) {
    if (maps.deposit_thickness[i] > scored.options.deposit_threshold) lowest = std::fmin(lowest, maps.before[i]);
  }
  sheet.number("runout_m", "run-out L, straight", "m", length, 0);
  sheet.number("drop_m", "drop H to there", "m", drop, 0);
  sheet.number("h_over_l", "H/L", "", drop / length, 4, "the deposit's farthest cell is the crown");
  sheet.number("fahrboeschung_deg", "Fahrboeschung", "deg", std::atan2(drop, length) * degrees, 2);
  sheet.number("max_drop_m", "largest drop, to the lowest deposit", "m", crown->z - lowest, 0);
}

void along_thalweg(const Scored& scored, Sheet& sheet) {
  const auto& maps = scored.run.maps;
  const auto far =
      farthest_along(scored.thalweg, maps.grid, maps.deposit_thickness, scored.options.deposit_threshold, maps.before);
  if (!far || !scored.crown)
    return sheet.skip({"thalweg_runout_m", "thalweg_drop_m", "thalweg_h_over_l", "thalweg_fahrboeschung_deg"},
                      scored.thalweg.line.empty() ? scored.thalweg.origin
                      : scored.crown              ? "no deposit above the threshold"
                                                  : "no release in the run's maps");
  const double length = far->distance - scored.crown_along, drop = scored.crown->z - far->place.z;
  sheet.text("thalweg", "thalweg", scored.thalweg.origin);
  sheet.number("thalweg_length_m", "length of the thalweg", "m", scored.thalweg.length(), 0);
  sheet.number("thalweg_runout_m", "run-out L along the thalweg", "m", length, 0);
  sheet.number("thalweg_drop_m", "drop H along the thalweg", "m", drop, 0);
  sheet.number("thalweg_h_over_l", "H/L along the thalweg", "", drop / length, 4, "the deposit ends at the crown");
  sheet.number("thalweg_fahrboeschung_deg", "Fahrboeschung along the thalweg", "deg",
               std::atan2(drop, length) * degrees, 2);
}

void centre(const Scored& scored, Sheet& sheet) {
  const auto& maps = scored.run.maps;
  const auto start = centre_of_mass(maps.grid, maps.initial_thickness, maps.terrain);
  const auto end = centre_of_mass(maps.grid, maps.deposit_thickness, maps.terrain);
  if (!start || !end)
    return sheet.skip({"centre_of_mass_travel_m", "centre_of_mass_drop_m", "travel_angle_deg"}, "no mass on the map");
  const double travel = plan_distance(*start, *end), drop = start->z - end->z;
  sheet.number("centre_of_mass_travel_m", "travel of the centre of mass", "m", travel, 1);
  sheet.number("centre_of_mass_drop_m", "drop of the centre of mass", "m", drop, 1);
  sheet.number("travel_angle_deg", "travel angle of the centre of mass", "deg", std::atan2(drop, travel) * degrees, 2);
}

}  // namespace

Reach reach_of(const Scored& scored, const MapGrid& grid, const std::vector<double>& values, double threshold) {
  if (!scored.crown) return {nan, nan};
  const auto toe = farthest(grid, values, threshold, *scored.crown, {});
  const auto end = farthest_along(scored.thalweg, grid, values, threshold, {});
  return {toe ? plan_distance(*scored.crown, *toe) : nan, end ? end->distance - scored.crown_along : nan};
}

void add_mobility(const Scored& scored, Sheet& sheet) {
  sheet.section("Mobility");
  straight(scored, sheet);
  along_thalweg(scored, sheet);
  centre(scored, sheet);
}

}  // namespace talus::postprocess
