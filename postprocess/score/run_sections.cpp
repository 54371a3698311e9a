// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run says by itself: volumes, cost, sanity, extent, mobility, what an authority asks.
#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include "common/map/statistics.hpp"
#include "common/run/mobility.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/hazard/hazard.hpp"
#include "postprocess/score/score.hpp"

namespace talus::postprocess {
namespace {

double area_above(const std::vector<double>& values, double threshold, double cell) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v > threshold; })) *
         cell * cell;
}

void volumes(const Scored& scored, Sheet& sheet) {
  const auto& run = scored.run;
  const auto& s = run.summary;
  const double on_map = volume_under(run.maps.deposit_thickness, run.maps.grid.cell);
  const auto release = release_numbers(run, release_limit(run.maps, scored.options.deposit_threshold));
  sheet.section("Volume");
  sheet.number("volume_released_m3", "released", "m3", s.volume_released, 0);
  sheet.number("volume_if_thickness_were_slope_normal_m3", "if its vertical thickness were read as slope-normal", "m3",
               release.volume_if_normal, 0);
  sheet.number("release_area_m2", "area of the release, in plan", "m2", release.area, 0);
  sheet.number("release_true_area_m2", "area of the release, along the slope", "m2", release.true_area, 0);
  if (!run.maps.eroded_depth.empty())
    sheet.number("volume_entrained_m3", "taken along from the ground", "m3", s.volume_entrained, 0);
  sheet.number("volume_final_m3", "in the domain at the end", "m3", s.volume_final, 0);
  sheet.number("volume_outflow_m3", "lost through the edge", "m3", s.volume_outflow, 0);
  sheet.number("volume_closure_error", "(released - end - lost) / released", "",
               (s.volume_released + s.volume_entrained - s.volume_final - s.volume_outflow) / s.volume_released, 12,
               "nothing was released");
  sheet.number("volume_on_map_m3", "under the deposit map", "m3", on_map, 0);
  sheet.number("volume_map_error", "(map - end) / released", "", (on_map - s.volume_final) / s.volume_released, 12,
               "nothing was released");
  sheet.number("max_release_thickness_m", "thickest release", "m", release.thickest, 2);
  sheet.number("p99_release_thickness_m", "thickest release, 99 % of its cells below", "m",
               p99_of_positive(run.maps.initial_thickness), 2, "nothing was released");
  sheet.number("max_release_thickness_slope_normal_m", "thickest release, normal to the slope", "m",
               release.thickest_normal, 2);
}

void computation(const Scored& scored, Sheet& sheet) {
  const auto& s = scored.run.summary;
  sheet.section("Computation");
  sheet.text("stop_reason", "stopped because", s.stop_reason);
  sheet.number("time_end_s", "stopped at", "s", s.time_end, 1);
  sheet.count("particles", "material points", s.particles);
  sheet.count("particles_outflow", "material points lost through the edge", s.particles_outflow);
  sheet.count("steps", "steps", s.steps);
  sheet.number("wall_time_s", "wall time of the steps", "s", s.wall_time, 1);
  sheet.text("on", "computed on", s.on);
  sheet.text("precision", "precision", s.precision);
  sheet.text("version", "version", s.version);
  if (const std::string id = fact(s.provenance, run_id); !id.empty()) sheet.text("run_id", "run", id);
}

void sanity(const Scored& scored, Sheet& sheet) {
  const RunSanity& found = scored.run.summary.sanity;
  if (found.words.empty()) return;  // a search for the factor of safety takes no steps in time
  sheet.section("Sanity");
  sheet.text("sanity", "the run is", found.words);
  for (const SanityNumber& number : sanity_numbers)
    sheet.number(number.name, number.label, number.unit, found.*(number.value), number.decimals, number.missing);
}

void extent(const Scored& scored, Sheet& sheet) {
  const auto& maps = scored.run.maps;
  const auto& options = scored.options;
  sheet.section("Extent");
  sheet.number("cell_m", "map cell", "m", maps.grid.cell, 2);
  sheet.number("footprint_threshold_m", "footprint: peak thickness above", "m", options.footprint_threshold,
               threshold_decimals(options.footprint_threshold));
  sheet.number("deposit_threshold_m", "deposit: final thickness above", "m", options.deposit_threshold,
               threshold_decimals(options.deposit_threshold));
  sheet.number("affected_area_m2", fmt::format("footprint area, > {:g} m", options.footprint_threshold), "m2",
               area_above(maps.peak_thickness, options.footprint_threshold, maps.grid.cell), 0);
  sheet.number("deposit_area_m2", fmt::format("deposit area, > {:g} m", options.deposit_threshold), "m2",
               area_above(maps.deposit_thickness, options.deposit_threshold, maps.grid.cell), 0);
  const auto extreme = [&](const std::string& key, const std::string& label, const char* unit,
                           const std::vector<double>& values, int decimals) {
    sheet.number("max_" + key, label, unit, largest(values), decimals);
    sheet.number("p99_" + key, label + ", 99 % of its cells below", unit, p99_of_positive(values), decimals,
                 "there is none");
  };
  extreme("deposit_thickness_m", "thickest deposit", "m", maps.deposit_thickness, 2);
  extreme("peak_thickness_m", "largest peak thickness", "m", maps.peak_thickness, 2);
  extreme("peak_speed_m_s", "largest peak speed", "m/s", maps.peak_speed, 1);
  extreme("peak_pressure_kpa", "largest peak pressure", "kPa", maps.peak_pressure_kPa, 1);
  const HistoryColumn* liquefied = scored.run.history.find("liquefied_share");
  if (!liquefied) return;
  sheet.number("max_pore_pressure_ratio", "largest share of the load in water", "", largest(maps.peak_pore_pressure),
               3);
  sheet.number("max_liquefied_share", "largest share of the mass liquefied", "", largest(liquefied->values), 3);
}

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
  for (std::size_t i = 0; i < maps.before.size(); ++i)
    if (maps.deposit_thickness[i] > scored.options.deposit_threshold) lowest = std::fmin(lowest, maps.before[i]);
  sheet.number("runout_m", fmt::format("run-out L, straight, to > {:g} m", scored.options.deposit_threshold), "m",
               length, 0);
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
  sheet.number("thalweg_runout_m",
               fmt::format("run-out L along the thalweg, to > {:g} m", scored.options.deposit_threshold), "m", length,
               0);
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

/// A score whose spread is asked for. `unit` also ends its keys, as "_m" or "_m3".
struct Line {
  const char *key, *label, *unit;
  int decimals;
  const std::vector<double>& draws;
};

void add_line(const Line& line, Sheet& sheet) {
  if (line.draws.empty()) return;
  const auto spread = spread_of(line.draws);
  const std::string end = *line.unit == '\0' ? "" : std::string("_") + line.unit;
  const std::pair<const char*, double> numbers[] = {
      {"mean", spread.mean}, {"sd", spread.deviation}, {"p05", spread.low}, {"p95", spread.high}};
  for (const auto& [name, value] : numbers) {
    sheet.number(fmt::format("{}_{}{}", line.key, name, end), fmt::format("{}, {}", line.label, name), line.unit, value,
                 line.decimals, "no draw has a value");
  }
}

}  // namespace

void warn_of_end(const Run& run) {
  constexpr double at_rest = 0.01;  // of the volume, and of the largest kinetic energy
  const auto values = [&](const char* name) {
    const HistoryColumn* column = run.history.find(name);
    return column == nullptr || column->values.empty() ? std::vector<double>{nan} : column->values;
  };
  const std::vector<double> kinetic = values("kinetic_J");
  const double energy = kinetic.back() / *std::max_element(kinetic.begin(), kinetic.end());
  const double moving = values("moving_volume_m3").back(), share = moving / values("volume_m3").back();
  if (!(energy > at_rest) && !(share > at_rest)) return;
  const double speed = values("moving_speed_m_s").back();
  warn("ended-before-rest",
       fmt::format(
           "the run ended before rest, at {:.3g} s with {:.3g} % of its largest kinetic energy ({}): {:.4g} m3, "
           "{:.3g} % of the mass, still moved faster than {:g} m/s, at {:.3g} m/s on average. The deposit is no "
           "final one. Give a larger end_time_s, and stop_kinetic_fraction = 0.001 or less, in [solve]",
           run.summary.time_end, 100 * energy, run.summary.stop_reason, moving, 100 * share, moving_faster_than, speed),
       {{"kinetic_energy_share", energy, "1"},
        {"moving_share", share, "1"},
        {"moving_volume", moving, "m3"},
        {"moving_speed", speed, "m s-1"},
        {"time", run.summary.time_end, "s"}});
}

void add_run(const Scored& scored, Sheet& sheet) {
  volumes(scored, sheet);
  computation(scored, sheet);
  sanity(scored, sheet);
  extent(scored, sheet);
}

void add_hazard(const Hazard& hazard, Sheet& sheet) {
  if (hazard.intensity) intensities(*hazard.intensity, sheet);
  if (!hazard.cones.empty()) cones(hazard.cones, sheet);
  if (!hazard.buildings.empty()) buildings(hazard.buildings, sheet);
}

Reach reach_of(const Scored& scored, const MapGrid& grid, const std::vector<double>& values, double threshold) {
  if (!scored.crown) return {nan, nan};
  const auto toe = farthest(grid, values, threshold, *scored.crown, {});
  const auto end = farthest_along(scored.thalweg, grid, values, threshold, {});
  return {toe ? plan_distance(*scored.crown, *toe) : nan, end ? end->distance - scored.crown_along : nan};
}

Reach surveyed_reach_of(const Scored& scored, const std::vector<double>& values, double threshold) {
  return reach_of(scored, scored.survey->grid, sure_patches(*scored.survey, values, threshold), threshold);
}

Reach simulated_reach(const Scored& scored, const OnSurveyGrid& simulated) {
  const double threshold = scored.options.deposit_threshold;
  if (scored.survey->usual_level() > 0) return reach_of(scored, scored.survey->grid, simulated.deposit, threshold);
  return reach_of(scored, scored.run.maps.grid, scored.run.maps.deposit_thickness, threshold);
}

void add_mobility(const Scored& scored, Sheet& sheet) {
  sheet.section("Mobility");
  straight(scored, sheet);
  along_thalweg(scored, sheet);
  centre(scored, sheet);
}

void add_spread(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  const auto& survey = *scored.survey;
  if (survey.error.sigma.empty())
    return sheet.skip({"deposit_csi_sd"}, fmt::format("the {}'s error (sigma) is not given", survey.words().noun));
  const auto all = resample(scored, simulated);
  sheet.section("Spread from the survey's error");
  sheet.count("resamples", "surveys drawn", scored.options.survey.resamples);
  sheet.number("survey_correlation_length_m", "range of the survey's errors", "m", survey.error.correlation_length, 1);
  if (!survey.footprint_is_change)
    sheet.skip({"footprint_csi_sd"}, "the footprint is not a surveyed change, its error is not known");
  for (const Line& line : {Line{"footprint_csi", "footprint CSI", "", 3, all.footprint_csi},
                           Line{"deposit_csi", "deposit CSI", "", 3, all.deposit_csi},
                           Line{"thickness_rmse", "thickness RMSE", "m", 2, all.rmse},
                           Line{"thickness_bias", "thickness bias", "m", 2, all.bias},
                           Line{"survey_deposit_volume", "surveyed deposit volume", "m3", 0, all.volume},
                           Line{"deposit_volume_ratio", "deposit volume ratio", "", 3, all.volume_ratio},
                           Line{"runout_difference", "run-out difference", "m", 0, all.runout_difference},
                           Line{"thalweg_runout_difference", "run-out difference along the thalweg", "m", 0,
                                all.thalweg_runout_difference}})
    add_line(line, sheet);
}

}  // namespace talus::postprocess
