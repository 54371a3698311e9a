// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the run itself says: volumes, cost, sanity, extent.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "postprocess/fields/classes.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/fields/release.hpp"
#include "postprocess/score/sections.hpp"

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
  sheet.number("volume_if_thickness_were_slope_normal_m3", "if its thickness were normal to the slope", "m3",
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
  sheet.number("footprint_threshold_m", "footprint: peak thickness above", "m", options.footprint_threshold, 2);
  sheet.number("deposit_threshold_m", "deposit: final thickness above", "m", options.deposit_threshold, 2);
  sheet.number("affected_area_m2", "footprint area", "m2",
               area_above(maps.peak_thickness, options.footprint_threshold, maps.grid.cell), 0);
  sheet.number("deposit_area_m2", "deposit area", "m2",
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
}

}  // namespace

void warn_of_end(const Run& run) {
  constexpr double at_rest = 0.01;  // of the largest kinetic energy
  const HistoryColumn* kinetic = run.history.find("kinetic_J");
  if (kinetic == nullptr || kinetic->values.empty() || run.summary.stop_reason != "end of the simulated time") return;
  const double peak = *std::max_element(kinetic->values.begin(), kinetic->values.end()), last = kinetic->values.back();
  if (!(last > at_rest * peak)) return;
  warn("ended-before-rest",
       fmt::format("the run ended before rest, at {:.3g} s with {:.3g} % of its largest kinetic energy: the deposit is "
                   "no final one. Give a larger end_time_s in [solve], and stop_kinetic_fraction = 0.001, which ends "
                   "the run at rest",
                   run.summary.time_end, 100 * last / peak),
       {{"kinetic_energy_share", last / peak, "1"}, {"time", run.summary.time_end, "s"}});
}

void add_run(const Scored& scored, Sheet& sheet) {
  volumes(scored, sheet);
  computation(scored, sheet);
  sanity(scored, sheet);
  extent(scored, sheet);
}

}  // namespace talus::postprocess
