// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What talus-preprocess found between the two elevation models: how they lay, what their difference is worth, and what
// moved.
import { area, h, number, quantity, volume } from "./format.js";

/** "225 000 ± 1600 m³": the error to two figures, the volume to as many places. */
export function volumeWords({ volume_m3: value, error_m3: error }) {
  if (!(error > 0)) return volume(value);
  const unit = 10 ** Math.max(0, Math.floor(Math.log10(error)) - 1);
  const rounded = (v) => number(Math.round(v / unit) * unit);
  return `${rounded(value)} \u00b1 ${rounded(error)}\u2009m\u00b3`;
}

const row = (label, value, words = "") =>
  h("tr", {}, h("td", {}, label), h("td", { class: "number" }, value), h("td", { class: "plain" }, words));
const group = (title) => h("tr", { class: "group" }, h("td", { colspan: 3 }, title));

/** "0.37 m east"; of a shift with its standard error and both in cells: "3.98 ± 0.05 m east (0.398 ± 0.005 cells)". */
function side(value, positive, negative, cell, error) {
  const with_error = (unit, places) =>
    number(Math.abs(value) / unit, places) + (error > 0 ? ` \u00b1 ${number(error / unit, places)}` : "");
  const words = `${with_error(1, 2)}\u2009m ${value < 0 ? negative : positive}`;
  return cell ? `${words} (${with_error(cell, 3)} cells)` : words;
}

/** What is said of a shift that is not known to a tenth of a cell. */
function shiftWords({ after_lies_error_cells: error }) {
  return error > 0.1
    ? `Known to ${number(error, 2)} cells only: stable ground is too little, too level or too noisy for more.`
    : "";
}

function alignmentRows({ alignment: a, cell_m: cell }) {
  if (!a.known)
    return [
      group("Alignment"),
      row(
        "stable ground",
        "too little",
        "How the later model lies on the earlier one is not known, nor the error of their difference.",
      ),
    ];
  const was = a.stable_ground_as_it_came,
    is = a.stable_ground_aligned;
  const rows = [
    group(a.applied ? "Alignment, corrected" : "Alignment, found and left as it was"),
    row(
      "the later model lay",
      side(a.after_lies_east_m, "east", "west", cell, a.after_lies_east_error_m),
      "Found on stable ground after Nuth & K\u00e4\u00e4b (2011), by bands of wavelengths; \u00b1 one standard error.",
    ),
    row("", side(a.after_lies_north_m, "north", "south", cell, a.after_lies_north_error_m), shiftWords(a)),
    row("", side(a.after_lies_high_m, "high", "low")),
  ];
  if (a.after_tilts_east_m_per_km || a.after_tilts_north_m_per_km) {
    rows.push(
      row(
        "tilted",
        `${number(a.after_tilts_east_m_per_km, 2)} and ${number(a.after_tilts_north_m_per_km, 2)}\u2009m/km`,
        "Towards the east and towards the north.",
      ),
    );
  }
  const change = (key, places) =>
    a.applied
      ? `${number(was[key], places)} \u2192 ${number(is[key], places)}\u2009m`
      : quantity(was[key], "m", places);
  rows.push(
    row("median difference there", change("median_m", 3), "Of ground that is neither steep nor rough nor changed."),
    row(
      "its spread (NMAD)",
      change("nmad_m", 3),
      "Normalised median absolute deviation: a standard deviation that wild values do not move.",
    ),
    row(
      "cells of stable ground",
      number(was.cells),
      `${number(100 * a.stable_share)}\u2009% of what both models hold.`,
    ),
  );
  return rows;
}

function errorRows({ error: e }) {
  if (e.known === false)
    return [
      group("Error of the difference"),
      row("standard error of a cell", "not known", "Nothing tells it: the models were not surveyed independently."),
    ];
  const v = e.variogram,
    alike = [
      [v.short_sill, v.short_range_m],
      [v.long_sill, v.long_range_m],
    ].filter(([sill]) => sill > 0);
  return [
    group("Error of the difference"),
    row(
      "standard error of a cell",
      quantity(e.cell_m, "m", 3),
      e.given ? "As given." : "Of unchanged ground; used by slope.",
    ),
    row(
      "level of detection",
      quantity(e.level_of_detection_m, "m", 2),
      "On level ground; smaller changes count as none.",
    ),
    row(
      "errors are alike over",
      alike.length
        ? alike.map(([sill, range]) => `${number(range)}\u2009m (${number(100 * sill)}\u2009%)`).join(", ")
        : "\u2013",
      "From the variogram of unchanged ground: the share of the variance in brackets. It decides what a volume is " +
        "worth.",
    ),
  ];
}

function volumeRows({ volumes, source, deposit, outside_slide: outside }) {
  const rows = [group("Volumes, \u00b1 one standard error")];
  for (const [body, name] of [
    [source, "source"],
    [deposit, "deposit"],
  ]) {
    if (body) rows.push(row(`${name}, as surveyed`, volumeWords(body), `On ${area(body.area_m2)}.`));
  }
  if (outside)
    rows.push(
      row(
        "rise outside the slide, no noise",
        volume(outside.sure_rise_m3),
        outside.large
          ? "Too much for a score."
          : outside.doubtful
            ? `Of what counts as noise ${volume(outside.noise_within_reach_rise_m3)} of rise ` +
              "lie within reach of the slide."
            : "",
      ),
      row("fall outside the slide, no noise", volume(outside.sure_fall_m3)),
    );
  for (const [budget, name] of [
    [volumes.raw, "all cells"],
    [volumes.beyond_level_of_detection, "beyond the level of detection"],
  ]) {
    for (const kind of ["erosion", "deposition", "net"]) rows.push(row(`${kind}, ${name}`, volumeWords(budget[kind])));
  }
  return rows;
}

export function drawSurveys(data) {
  const section = document.getElementById("surveys-section"),
    { surveys } = data;
  section.hidden = !surveys;
  document.querySelector('a[href="#surveys-section"]').hidden = !surveys;
  if (!surveys) return;
  const rows = [...alignmentRows(surveys), ...errorRows(surveys), ...volumeRows(surveys)];
  document
    .getElementById("surveys")
    .append(h("div", { class: "scroll" }, h("table", { class: "data" }, h("tbody", {}, rows))));
}
