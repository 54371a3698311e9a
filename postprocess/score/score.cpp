#include "postprocess/score/score.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include <fmt/format.h>

#include "postprocess/maps/fields.hpp"
#include "postprocess/score/contingency.hpp"
#include "postprocess/score/mobility.hpp"

namespace talus::postprocess {
namespace {

constexpr double degrees = 180 / std::numbers::pi;

double largest(const std::vector<double>& values) {
  double top = 0;
  for (const double v : values) {
    if (v > top) top = v;
  }
  return top;
}

double area_above(const std::vector<double>& values, double threshold, double cell) {
  return static_cast<double>(std::count_if(values.begin(), values.end(), [&](double v) { return v > threshold; })) *
         cell * cell;
}

/// Fills a Score; a number that is not finite goes to not_scored with the reason given.
class Builder {
 public:
  Builder(const Run& run, const Options& options, const std::optional<Survey>& survey)
      : run_(run), options_(options), survey_(survey) {}

  Score build() {
    score_.title = run_.summary.title;
    volumes();
    computation();
    extent();
    mobility();
    if (survey_)
      agreement();
    else
      skip({"footprint_csi", "deposit_csi", "thickness_rmse_m", "thickness_bias_m"}, "no survey is given");
    definitions();
    return std::move(score_);
  }

 private:
  void section(std::string title) { score_.sections.push_back({std::move(title), {}}); }
  void text(std::string key, std::string label, std::string value) {
    score_.sections.back().entries.push_back({std::move(key), std::move(label), "", std::move(value), 0});
  }
  void count(std::string key, std::string label, std::int64_t value) {
    score_.sections.back().entries.push_back({std::move(key), std::move(label), "", value, 0});
  }
  void number(std::string key, std::string label, std::string unit, double value, int decimals,
              const char* missing = "not a number") {
    if (std::isfinite(value)) {
      score_.sections.back().entries.push_back({std::move(key), std::move(label), std::move(unit), value, decimals});
    } else {
      score_.not_scored.emplace_back(std::move(key), missing);
    }
  }
  void skip(std::initializer_list<const char*> keys, const std::string& why) {
    for (const auto* key : keys) score_.not_scored.emplace_back(key, why);
  }

  void volumes();
  void computation();
  void extent();
  void mobility();
  void agreement();
  void deposit_agreement(const OnSurveyGrid& simulated);
  void footprint_agreement(const OnSurveyGrid& simulated);
  void reach_agreement();
  void areas(const std::string& what, const Contingency& c);
  void definitions();

  const Run& run_;
  const Options& options_;
  const std::optional<Survey>& survey_;
  Score score_;
  std::optional<Place> crown_;
  double runout_ = std::numeric_limits<double>::quiet_NaN();
};

void Builder::volumes() {
  const auto& s = run_.summary;
  const double on_map = volume_under(run_.maps.deposit_thickness, run_.maps.grid.cell);
  section("Volume");
  number("volume_released_m3", "released", "m3", s.volume_released, 0);
  if (!run_.maps.eroded_depth.empty()) number("volume_entrained_m3", "taken along from the ground", "m3", s.volume_entrained, 0);
  number("volume_final_m3", "in the domain at the end", "m3", s.volume_final, 0);
  number("volume_outflow_m3", "left through the edge", "m3", s.volume_outflow, 0);
  number("volume_closure_error", "(released - end - left) / released", "",
         (s.volume_released + s.volume_entrained - s.volume_final - s.volume_outflow) / s.volume_released, 12, "nothing was released");
  number("volume_on_map_m3", "under the deposit map", "m3", on_map, 0);
  number("volume_map_error", "(map - end) / released", "", (on_map - s.volume_final) / s.volume_released, 12,
         "nothing was released");
}

void Builder::computation() {
  const auto& s = run_.summary;
  section("Computation");
  count("particles", "material points", s.particles);
  count("particles_outflow", "material points left through the edge", s.particles_outflow);
  count("steps", "steps", s.steps);
  number("time_end_s", "simulated time", "s", s.time_end, 1);
  number("wall_time_s", "wall time of the steps", "s", s.wall_time, 1);
  text("stop_reason", "stopped because", s.stop_reason);
  text("on", "computed on", s.on);
  text("precision", "precision", s.precision);
  text("version", "version", s.version);
}

void Builder::extent() {
  const auto& maps = run_.maps;
  const double footprint = area_above(maps.peak_thickness, options_.footprint_threshold, maps.grid.cell);
  const double deposit = area_above(maps.deposit_thickness, options_.deposit_threshold, maps.grid.cell);
  section("Extent");
  number("cell_m", "map cell", "m", maps.grid.cell, 2);
  number("footprint_threshold_m", "footprint: peak thickness above", "m", options_.footprint_threshold, 2);
  number("deposit_threshold_m", "deposit: final thickness above", "m", options_.deposit_threshold, 2);
  number("affected_area_m2", "footprint area", "m2", footprint, 0);
  number("deposit_area_m2", "deposit area", "m2", deposit, 0);
  number("max_release_thickness_m", "thickest release", "m", largest(maps.initial_thickness), 2);
  number("max_deposit_thickness_m", "thickest deposit", "m", largest(maps.deposit_thickness), 2);
  number("max_peak_thickness_m", "largest peak thickness", "m", largest(maps.peak_thickness), 2);
  number("max_peak_speed_m_s", "largest peak speed", "m/s", largest(maps.peak_speed), 1);
  number("max_peak_pressure_kpa", "largest peak pressure", "kPa", largest(maps.peak_pressure), 1);
}

void Builder::mobility() {
  const auto& maps = run_.maps;
  section("Mobility");
  crown_ = crown(maps, options_.deposit_threshold);
  const auto toe = crown_
                       ? farthest(maps.grid, maps.deposit_thickness, options_.deposit_threshold, *crown_, maps.before)
                       : std::nullopt;
  if (toe) {
    runout_ = plan_distance(*crown_, *toe);
    const double drop = crown_->z - toe->z;
    number("runout_m", "run-out L", "m", runout_, 0);
    number("drop_m", "drop H", "m", drop, 0);
    number("h_over_l", "H/L", "", drop / runout_, 4, "the deposit's farthest cell is the crown");
    number("fahrboeschung_deg", "Fahrboeschung", "deg", std::atan2(drop, runout_) * degrees, 2);
  } else {
    skip({"runout_m", "drop_m", "h_over_l", "fahrboeschung_deg"},
         crown_ ? "no deposit above the threshold" : "no release in the run's maps");
  }
  const auto start = centre_of_mass(maps.grid, maps.initial_thickness, maps.terrain);
  const auto end = centre_of_mass(maps.grid, maps.deposit_thickness, maps.terrain);
  if (!start || !end)
    return skip({"centre_of_mass_travel_m", "centre_of_mass_drop_m", "travel_angle_deg"}, "no mass on the map");
  number("centre_of_mass_travel_m", "travel of the centre of mass", "m", plan_distance(*start, *end), 1);
  number("centre_of_mass_drop_m", "drop of the centre of mass", "m", start->z - end->z, 1);
  number("travel_angle_deg", "travel angle of the centre of mass", "deg",
         std::atan2(start->z - end->z, plan_distance(*start, *end)) * degrees, 2);
}

void Builder::agreement() {
  const auto simulated = bring_to_survey_grid(run_.maps, *survey_);
  section("Agreement with: " + survey_->name);
  footprint_agreement(simulated);
  deposit_agreement(simulated);
  reach_agreement();
  number("deposit_not_surveyed_m3", "simulated deposit where nothing was surveyed", "m3", simulated.deposit_left_out,
         0);
  const double share = simulated.deposit_left_out / run_.summary.volume_released;
  if (share > 0.01) {
    score_.notes.push_back(
        fmt::format("Warning: {:.1f} % of the simulated deposit lies where the survey has no data; it is not in the "
                    "scores. If no data means no deposit, set nodata_is_zero.",
                    100 * share));
  }
}

void Builder::areas(const std::string& what, const Contingency& c) {
  number(what + "_csi", what + " CSI", "", c.csi(), 3, "neither side exceeds the threshold");
  number(what + "_hss", what + " Heidke skill score", "", c.hss(), 3, "everywhere the same");
  number(what + "_d2pc", what + " distance to perfect classification", "", c.d2pc(), 3, "one side has no area");
  number(what + "_foc", what + " area, simulated / surveyed", "", c.foc(), 3,
         "the survey exceeds the threshold nowhere");
  number(what + "_true_positive_m2", what + " in both (TP)", "m2", c.true_positive, 0);
  number(what + "_false_positive_m2", what + " in the simulation only (FP)", "m2", c.false_positive, 0);
  number(what + "_false_negative_m2", what + " in the survey only (FN)", "m2", c.false_negative, 0);
  number(what + "_true_negative_m2", what + " in neither (TN)", "m2", c.true_negative, 0);
}

void Builder::footprint_agreement(const OnSurveyGrid& simulated) {
  if (survey_->footprint.empty()) {
    return skip({"footprint_csi"},
                "the survey gives a deposit only (peak_thickness or polygon would give its footprint)");
  }
  areas("footprint", compare(simulated.peak, options_.footprint_threshold, survey_->footprint,
                             survey_->footprint_threshold, survey_->grid.cell * survey_->grid.cell));
}

void Builder::deposit_agreement(const OnSurveyGrid& simulated) {
  if (survey_->deposit.empty()) {
    return skip({"deposit_csi", "thickness_rmse_m", "thickness_bias_m"}, "the survey gives a footprint only");
  }
  const auto& grid = survey_->grid;
  areas("deposit", compare(simulated.deposit, options_.deposit_threshold, survey_->deposit, options_.deposit_threshold,
                           grid.cell * grid.cell));
  const auto error = thickness_error(simulated.deposit, survey_->deposit, options_.deposit_threshold);
  constexpr const char* none = "neither deposit exceeds the threshold";
  number("thickness_rmse_m", "thickness RMSE", "m", error.rmse, 2, none);
  number("thickness_bias_m", "thickness bias (simulated - surveyed)", "m", error.bias, 2, none);
  number("thickness_mae_m", "thickness mean absolute error", "m", error.mean_absolute, 2, none);
  const double volume = volume_under(survey_->deposit, grid.cell);
  number("survey_deposit_volume_m3", "surveyed deposit volume", "m3", volume, 0);
  number("deposit_volume_ratio", "deposit volume, simulated / surveyed", "",
         volume_under(simulated.deposit, grid.cell) / volume, 3, "the survey holds no deposit");
  number("survey_max_deposit_thickness_m", "thickest surveyed deposit", "m", largest(survey_->deposit), 2);
  const auto here = centre_of_mass(grid, simulated.deposit, {}), there = centre_of_mass(grid, survey_->deposit, {});
  if (here && there)
    number("centre_of_mass_offset_m", "centre-of-mass offset of the deposits", "m", plan_distance(*here, *there), 1);
}

void Builder::reach_agreement() {
  const bool by_deposit = !survey_->deposit.empty();
  const auto toe = crown_
                       ? farthest(survey_->grid, by_deposit ? survey_->deposit : survey_->footprint,
                                  by_deposit ? options_.deposit_threshold : survey_->footprint_threshold, *crown_, {})
                       : std::nullopt;
  if (!toe) return skip({"survey_runout_m", "runout_difference_m"}, "the survey exceeds the threshold nowhere");
  const double surveyed = plan_distance(*crown_, *toe);
  number("survey_runout_m", "surveyed run-out, from the same crown", "m", surveyed, 0);
  number("runout_difference_m", "run-out, simulated - surveyed", "m", runout_ - surveyed, 0,
         "the simulation has no run-out");
}

void Builder::definitions() {
  auto& notes = score_.notes;
  notes.push_back(
      "Thickness is vertical. Run-out: straight in plan from the crown (highest release cell) to the farthest deposit "
      "cell; "
      "H: drop of the surface before the failure between the two.");
  if (!survey_) return;
  if (!survey_->deposit.empty()) {
    notes.push_back(
        survey_->deposit_is_change
            ? "Deposit: rise of the surface on both sides, max(0, after - before) against max(0, final - initial "
              "thickness), so that the scar is not counted as missing deposit."
            : "Deposit: final thickness on both sides.");
    notes.push_back("RMSE, bias and mean absolute error: over the union of both deposits above the threshold.");
  }
  if (!survey_->footprint.empty()) {
    notes.push_back(!survey_->polygons.empty()
                        ? "Footprint: peak thickness above the threshold against the inside of the polygon."
                    : survey_->footprint_is_change
                        ? "Footprint: peak thickness above the threshold against |after - before| above it."
                        : "Footprint: peak thickness above the threshold on both sides.");
  }
  notes.push_back(fmt::format(
      "Compared on the survey's grid ({} x {} cells of {:g} m), brought there by area weights, which keep volume. "
      "CSI = TP / (TP + FP + FN).",
      survey_->grid.columns, survey_->grid.rows, survey_->grid.cell));
}

}  // namespace

std::optional<double> Score::number(const std::string& key) const {
  for (const auto& section : sections) {
    for (const auto& entry : section.entries) {
      if (entry.key == key && std::holds_alternative<double>(entry.value)) return std::get<double>(entry.value);
    }
  }
  return std::nullopt;
}

Score make_score(const Run& run, const Options& options, const std::optional<Survey>& survey) {
  return Builder(run, options, survey).build();
}

}  // namespace talus::postprocess
