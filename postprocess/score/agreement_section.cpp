// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Simulation against survey, cell by cell, in volume and in reach; what the numbers mean.
#include <cmath>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"
#include "postprocess/score/contingency.hpp"
#include "postprocess/score/score.hpp"

namespace talus::postprocess {
namespace {

/// One map of each side, what counts as yes on it, and how far yes reaches.
struct Pair {
  std::string what;
  ReferenceWords words;
  const std::vector<double>&simulated, &covered, &surveyed;  // covered: the share of each cell
  double simulated_threshold, surveyed_threshold;
  Reach simulated_reach, surveyed_reach;
};

void overlap(const Pair& pair, double cell_area, Sheet& sheet) {
  const auto& what = pair.what;
  const std::string noun = pair.words.noun, adjective = pair.words.adjective;
  const auto c = compare(pair.covered, most_of_a_cell, pair.surveyed, pair.surveyed_threshold, cell_area);
  sheet.number(what + "_csi", fmt::format("{} CSI, > {:g} m", what, pair.simulated_threshold), "", c.csi(), 3,
               "neither side exceeds the threshold");
  sheet.number(what + "_hss", what + " Heidke skill score", "", c.hss(), 3, "everywhere the same");
  sheet.number(what + "_auroc", what + " AUROC", "", auroc(pair.simulated, pair.surveyed, pair.surveyed_threshold), 3,
               "the " + noun + " says the same everywhere");
  sheet.number(what + "_d2pc", what + " distance to perfect classification", "", c.d2pc(), 3, "one side has no area");
  sheet.number(what + "_foc", what + " area, simulated / " + adjective + " (FoC)", "", c.foc(), 3,
               "the " + noun + " exceeds the threshold nowhere");
  sheet.number(what + "_spi", what + " synthetic performance index", "",
               c.spi(pair.simulated_reach.along / pair.surveyed_reach.along), 3,
               "one side has no run-out along the thalweg");
  sheet.number(what + "_true_positive_m2", what + " in both (TP)", "m2", c.true_positive, 0);
  sheet.number(what + "_false_positive_m2", what + " in the simulation only (FP)", "m2", c.false_positive, 0);
  sheet.number(what + "_false_negative_m2", what + " in the " + noun + " only (FN)", "m2", c.false_negative, 0);
  sheet.number(what + "_true_negative_m2", what + " in neither (TN)", "m2", c.true_negative, 0);
}

void thickness(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  const auto& survey = *scored.survey;
  const auto error = thickness_error(simulated.deposit, survey.deposit, scored.options.deposit_threshold);
  const std::string adjective = survey.words().adjective;
  constexpr const char* none = "neither deposit exceeds the threshold";
  sheet.number("thickness_rmse_m", "thickness RMSE", "m", error.rmse, 2, none);
  sheet.number("thickness_bias_m", "thickness bias (simulated - " + adjective + ")", "m", error.bias, 2, none);
  sheet.number("thickness_mae_m", "thickness mean absolute error", "m", error.mean_absolute, 2, none);
  sheet.number("thickness_median_m", "thickness median difference", "m", error.median, 2, none);
  sheet.number("thickness_nmad_m", "thickness NMAD", "m", error.nmad, 2, none);
  const double volume = volume_under(survey.deposit, survey.grid.cell);
  sheet.number("survey_deposit_volume_m3", adjective + " deposit volume", "m3", volume, 0);
  sheet.number("deposit_volume_ratio", "deposit volume, simulated / " + adjective, "",
               volume_under(simulated.deposit, survey.grid.cell) / volume, 3,
               "the " + std::string(survey.words().noun) + " holds no deposit");
  sheet.number("survey_max_deposit_thickness_m", "thickest " + adjective + " deposit", "m", largest(survey.deposit), 2);
}

void centre_offset(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  const auto& survey = *scored.survey;
  const auto here = centre_of_mass(survey.grid, simulated.deposit, {}),
             there = centre_of_mass(survey.grid, survey.deposit, {});
  if (!here || !there)
    return sheet.skip({"centre_of_mass_offset_m", "centre_of_mass_offset_along_m"}, "one side has no deposit");
  sheet.number("centre_of_mass_offset_m", "centre-of-mass offset of the deposits", "m", plan_distance(*here, *there),
               1);
  sheet.number(
      "centre_of_mass_offset_along_m",
      "the same along the thalweg, simulated - " + std::string(survey.words().adjective), "m",
      project(scored.thalweg, here->x, here->y).distance - project(scored.thalweg, there->x, there->y).distance, 1,
      scored.thalweg.origin);
}

void residuals(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  const auto& survey = *scored.survey;
  if (survey.error.sigma.empty())
    return sheet.skip({"residual_median_sigma", "residual_within_95", "residual_chi2"},
                      "the " + std::string(survey.words().noun) + "'s error (sigma) is not given");
  const double threshold = scored.options.deposit_threshold;
  std::vector<char> counts(simulated.deposit.size());
  for (std::size_t i = 0; i < counts.size(); ++i)
    counts[i] = simulated.deposit[i] > threshold || survey.deposit[i] > threshold;
  const auto r = residual_of(simulated.change, survey.measured, survey.error.sigma, counts);
  const std::string none = "no deposit where the " + std::string(survey.words().noun) + " has an error";
  sheet.count("residual_cells", "cells with a deposit and a sigma", static_cast<std::int64_t>(r.cells));
  sheet.number("residual_median_sigma", "median residual over sigma", "", r.median, 2, none);
  sheet.number("residual_within_95", "share of cells within 1.96 sigma", "", r.within, 3, none);
  sheet.number("residual_chi2", "reduced chi-square", "", r.chi_squared, 2, none);
}

/// The run-outs of both sides, and whether the simulated one leaves out what the survey could not detect [m].
struct Reaches {
  double reference, simulated;
  bool detects;
};

/// A pair of run-outs and their difference, under keys that begin as named.
void reach_lines(const std::string& key, const std::string& label, const ReferenceWords& words, const Reaches& reach,
                 Sheet& sheet) {
  const std::string nowhere = "the " + std::string(words.noun) + " exceeds the threshold nowhere";
  const std::string adjective = words.adjective;
  sheet.number("survey_" + key + "_m", adjective + " " + label, "m", reach.reference, 0, nowhere);
  if (reach.detects)
    sheet.number(key + "_detectable_m", label + ", simulated, above the level of detection", "m", reach.simulated, 0,
                 "nothing simulated exceeds it");
  sheet.number(key + "_difference_m", label + ", simulated - " + adjective, "m", reach.simulated - reach.reference, 0,
               std::isfinite(reach.reference) ? "the simulation has no run-out" : nowhere);
}

/// Says where the level of detection, and not the threshold, decides what counts.
void blind_zone(const Scored& scored, Sheet& sheet) {
  const auto& survey = *scored.survey;
  const double threshold = scored.options.deposit_threshold;
  double cells = 0, blind = 0;
  for (std::size_t i = 0; i < survey.measured.size(); ++i) {
    if (std::isnan(survey.measured[i]) || survey.measured[i] == 0) continue;
    cells += 1;
    blind += survey.error.level(i) > threshold ? 1 : 0;
  }
  if (blind > 0.01 * cells)
    sheet.note(
        fmt::format("The level of detection lies above the deposit threshold of {:g} m on {:.0f} % of the {} cells: "
                    "thinner deposit counts as none there, in the simulation too.",
                    threshold, 100 * blind / cells, survey.words().adjective));
}

void left_out(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  sheet.number("deposit_not_surveyed_m3",
               "simulated deposit where the " + std::string(scored.survey->words().noun) + " has no data", "m3",
               simulated.deposit_left_out, 0);
  const double share = simulated.deposit_left_out / scored.run.summary.volume_released;
  if (share > 0.01)
    sheet.note(
        fmt::format("Warning: {:.1f} % of the simulated deposit lies where the {} has no data; it is not in the "
                    "scores. If no data means no deposit, fill it: gdalwarp -dstnodata 0 IN.tif OUT.tif, then "
                    "gdal_edit.py -unsetnodata OUT.tif.",
                    100 * share, scored.survey->words().noun));
}

void of_run(const Scored& scored, Sheet& sheet) {
  sheet.note(
      "Thickness is vertical. Read as normal to the slope, that of the release gives the volume of the second line: "
      "thickness times area over the cosine of the slope.");
  sheet.note(
      "Run-out: in plan from the crown (highest release cell), straight to the farthest deposit cell, or along the "
      "thalweg to "
      "the deposit cell farthest along it; H: drop of the surface before the failure between the two; Fahrboeschung: "
      "atan(H/L); travel angle: the same of the centre of mass.");
  if (!scored.thalweg.line.empty())
    sheet.note(fmt::format("Thalweg: {}{}.", scored.thalweg.origin,
                           scored.thalweg.given
                               ? ", from its higher end"
                               : "; carried on through the thickest flow to the crown and the farthest "
                                 "deposit of either side, and smoothed"));
}

void of_maps(const Survey& survey, Sheet& sheet) {
  if (!survey.deposit.empty()) {
    sheet.note(
        survey.deposit_is_change
            ? "Deposit: rise of the surface on both sides, max(0, after - before) against max(0, final - initial "
              "thickness), so that the scar is not counted as missing deposit."
            : "Deposit: final thickness on both sides.");
    sheet.note(
        "RMSE, bias, mean absolute error, median and NMAD (1.4826 times the median distance from the median): over the "
        "union of both deposits above the threshold.");
  }
  if (!survey.footprint.empty()) {
    sheet.note(!survey.polygons.empty()
                   ? "Footprint: peak thickness above the threshold against the inside of the polygon."
               : survey.footprint_is_change
                   ? "Footprint: peak thickness above the threshold against |after - before| above it."
                   : "Footprint: peak thickness above the threshold on both sides.");
  }
  if (survey.kind == ReferenceKind::model)
    sheet.note("Reference: the run of another model, " + survey.name + ". It was not surveyed.");
  sheet.note(
      fmt::format("Compared on the {}'s grid ({} x {} cells of {:g} m), brought there by area weights, which keep "
                  "volume; a cell is covered from "
                  "one half on.",
                  survey.words().noun, survey.grid.columns, survey.grid.rows, survey.grid.cell));
}

void of_scores(const ReferenceWords& words, Sheet& sheet) {
  const std::string noun = words.noun;
  sheet.note(
      "CSI = TP / (TP + FP + FN); HSS: agreement beyond chance; D2PC = sqrt((1 - TP/(TP + FN))^2 + (FP/(FP + TN))^2); "
      "FoC = "
      "(TP + FP) / (TP + FN); AUROC: chance that a cell the " +
      noun +
      " says yes to has the larger simulated thickness than one it says no to. HSS, D2PC and AUROC depend on how "
      "much untouched ground the " +
      noun + "'s grid holds.");
  sheet.note(
      "SPI (r.avaflow): mean of CSI, HSS, 1 - D2PC, sin^5(pi/2 min(FoC, 1/FoC)) and the same of the ratio of run-outs "
      "along the "
      "thalweg, with TN = 5 (TP + FN) - FP.");
}

void of_error(const Scored& scored, Sheet& sheet) {
  const auto& error = scored.survey->error;
  if (error.sigma.empty() && error.noise > 0)
    sheet.note(fmt::format(
        "Level of detection: the survey's error is not given. By what was measured where the run left the ground "
        "alone it is {:.2g} m (five standard deviations, 1 m at most); less counts as none, in the simulation too.",
        error.noise));
  if (error.sigma.empty()) return;
  sheet.note(fmt::format("Level of detection: values below {:g} sigma count as none, {} and simulated.",
                         error.detection, scored.survey->words().adjective));
  sheet.note(
      "Residual over sigma: simulated - measured, before the level of detection, over the cells of the union of both "
      "deposits; "
      "reduced chi-square is the mean of its square.");
  sheet.note(
      "Spread: mean, standard deviation, 5 % and 95 % quantile over surveys drawn as measured + sigma times a "
      "Gaussian random "
      "field of spherical correlation, each scored as the survey is. Cells measured as exactly 0 stay so; for the "
      "run-out "
      "only deposits count that touch one of the survey. The survey holds one such error already, so the mean is not "
      "the score.");
}

}  // namespace

void add_agreement(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet) {
  const auto& survey = *scored.survey;
  const auto& options = scored.options;
  const auto& maps = scored.run.maps;
  const double area = survey.grid.cell * survey.grid.cell;
  const double level = survey.usual_level();
  const bool detects = level > 0;
  const auto deposit_reach = simulated_reach(scored, simulated);
  Reach surveyed_reach{nan, nan};
  const std::string noun = survey.words().noun;
  sheet.section("Agreement with: " + survey.name);
  if (detects) sheet.number("survey_detection_m", "level of detection, median: less counts as none", "m", level, 2);
  if (survey.footprint.empty()) {
    sheet.skip({"footprint_csi"},
               "the " + noun + " gives a deposit only (peak_thickness or polygon would give its footprint)");
  } else {
    surveyed_reach = surveyed_reach_of(scored, survey.footprint, survey.footprint_threshold);
    overlap({"footprint", survey.words(), simulated.peak, simulated.touched, survey.footprint,
             options.footprint_threshold, survey.footprint_threshold,
             reach_of(scored, maps.grid, maps.peak_thickness, options.footprint_threshold), surveyed_reach},
            area, sheet);
  }
  if (survey.deposit.empty()) {
    sheet.skip({"deposit_csi", "thickness_rmse_m", "thickness_bias_m"}, "the " + noun + " gives a footprint only");
  } else {
    surveyed_reach = surveyed_reach_of(scored, survey.deposit, options.deposit_threshold);
    overlap({"deposit", survey.words(), simulated.deposit, simulated.covered, survey.deposit, options.deposit_threshold,
             options.deposit_threshold, deposit_reach, surveyed_reach},
            area, sheet);
    thickness(scored, simulated, sheet);
    residuals(scored, simulated, sheet);
    centre_offset(scored, simulated, sheet);
  }
  const std::string limit = fmt::format(", to > {:g} m", options.deposit_threshold);
  reach_lines("runout", "run-out, straight" + limit, survey.words(),
              {surveyed_reach.straight, deposit_reach.straight, detects}, sheet);
  reach_lines("thalweg_runout", "run-out along the thalweg" + limit, survey.words(),
              {surveyed_reach.along, deposit_reach.along, detects}, sheet);
  left_out(scored, simulated, sheet);
  blind_zone(scored, sheet);
}

void add_definitions(const Scored& scored, Sheet& sheet) {
  of_run(scored, sheet);
  if (scored.survey == nullptr) return;
  of_maps(*scored.survey, sheet);
  of_scores(scored.survey->words(), sheet);
  of_error(scored, sheet);
  for (const auto& note : scored.survey->notes) sheet.note(note);
}

}  // namespace talus::postprocess
