// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Plain words for scores, by the end of their key.

const definitions = [
  [
    /_csi$/,
    "Critical success index (intersection over union): area in both over area in either. 1 is perfect, 0 no overlap.",
  ],
  [/_hss$/, "Heidke skill score: agreement beyond what chance would give. 1 is perfect, 0 chance."],
  [
    /_auroc$/,
    "Area under the receiver operating characteristic: how well thickness ranks affected before unaffected cells. " +
      "1 is perfect, 0.5 chance.",
  ],
  [/_spi$/, "Synthetic performance index: several of these scores in one number. 1 is perfect."],
  [/_d2pc$/, "Distance to perfect classification in ROC space. 0 is perfect."],
  [
    /_foc$/,
    "Factor of conservativeness: simulated over {adjective} area. Above 1 the simulation covers more than the {noun}.",
  ],
  [/true_positive/, "Area that both simulation and {noun} affect."],
  [/false_positive/, "Area that the simulation alone affects: false alarm."],
  [/false_negative/, "Area that the {noun} alone affects: missed."],
  [/true_negative/, "Area that neither affects. Grows with the map, so it says little by itself."],
  [/rmse/, "Root mean square of simulated minus {adjective} thickness where either deposit lies."],
  [/bias/, "Mean of simulated minus {adjective} thickness where either deposit lies. Above 0: too thick."],
  [/mae/, "Mean size of the difference of thickness where either deposit lies."],
  [/nmad/, "Normalised median absolute deviation: a spread that single large errors do not move."],
  [/volume_ratio/, "Simulated over {adjective} volume. 1 is equal."],
  [/runout_difference/, "Simulated minus {adjective} run-out. Above 0: the simulation goes farther."],
  [/centre_of_mass_offset_along/, "The same, along the thalweg. Above 0: the simulated deposit lies farther down."],
  [/centre_of_mass_offset/, "Distance in plan between the centres of mass of the two deposits."],
  [/^survey_runout/, "Run-out of the {noun}, measured from the simulation's crown."],
  [/^thalweg_runout_m$/, "Along the thalweg, from the crown to the farthest deposit."],
  [/residual_within_95/, "Share of cells whose difference lies within the {noun}'s own 95 % error."],
  [/residual_median_sigma/, "Median of the difference, in standard errors of the {noun}. Above 0: too thick."],
  [
    /residual_chi2/,
    "Mean square of the difference over the {noun}'s error. Near 1 the {noun}'s own error explains it.",
  ],
  [/thickness_median/, "Median of simulated minus {adjective} thickness where either deposit lies."],
  [/^runout_m$/, "Straight in plan from the crown (highest cell of the release) to the farthest deposit."],
  [/^drop_m$/, "Drop of the surface before the failure from the crown to the farthest deposit."],
  [/^h_over_l$/, "Drop over run-out: the smaller, the more mobile."],
  [/fahrboeschung/, "Angle whose tangent is H/L."],
  [/travel_angle/, "Angle whose tangent is drop over travel of the centre of mass; close to the mean friction angle."],
  [/closure_error|map_error/, "What the bookkeeping of volume loses; rounding only."],
  [/_not_surveyed/, "Simulated deposit on cells where the {noun} has no data; in no score."],
];

/** `reference`: what the run is compared with, data.run.survey; null where it is with nothing. */
export function definition(key, reference) {
  const words = definitions.find(([pattern]) => pattern.test(key))?.[1] ?? "";
  return words
    .replaceAll("{noun}", reference?.noun ?? "survey")
    .replaceAll("{adjective}", reference?.adjective ?? "surveyed");
}

export function steps(get) {
  const integrator = get("solve", "integrator");
  const words = {
    explicit: "explicit steps below the Courant limit",
    newmark:
      "implicit Newmark steps, solved by Newton's method on consistent tangents (Charlton, Coombs & Augarde 2017)",
    "quasi-static": "quasi-static steps without inertia, solved by Newton's method (Charlton, Coombs & Augarde 2017)",
    auto: "explicit or implicit Newmark steps, whichever took less time",
  };
  return words[integrator] ?? `the integrator "${integrator}"`;
}
