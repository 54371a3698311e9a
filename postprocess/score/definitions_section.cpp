// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The words under score.txt: what the numbers mean.
#include <fmt/format.h>

#include "postprocess/score/sections.hpp"

namespace talus::postprocess {
namespace {

void of_run(const Scored& scored, Sheet& sheet) {
  sheet.note(
      "Thickness is vertical. Were the release's thickness normal to the slope, its volume would be that of the second "
      "line: "
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
                                 "deposit, and smoothed"));
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
  sheet.note(fmt::format(
      "Compared on the {}'s grid ({} x {} cells of {:g} m), brought there by area weights, which keep volume.",
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
  if (error.sigma.empty()) return;
  sheet.note(fmt::format("Level of detection: {} values below {:g} sigma count as none.",
                         scored.survey->words().adjective, error.detection));
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

void add_definitions(const Scored& scored, Sheet& sheet) {
  of_run(scored, sheet);
  if (scored.survey == nullptr) return;
  of_maps(*scored.survey, sheet);
  of_scores(scored.survey->words(), sheet);
  of_error(scored, sheet);
  for (const auto& note : scored.survey->notes) sheet.note(note);
}

}  // namespace talus::postprocess
