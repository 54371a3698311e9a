// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What came to each building.
import { h, number, scaled } from "./format.js";

function table(id, heads, rows) {
  const head = heads.map((words, i) => h("th", { class: i ? "number" : null }, words));
  const body = rows.map((row) =>
    h(
      "tr",
      {},
      row.map((words, i) => h("td", { class: i ? "number" : null }, words)),
    ),
  );
  return h(
    "div",
    { class: "scroll" },
    h("table", { class: "data", id }, h("thead", {}, h("tr", {}, head)), h("tbody", {}, body)),
  );
}

/** "12.3 (11.9)": the largest, and in brackets the 99th percentile of the cells. */
function withPercentile([largest, p99], decimals) {
  return `${number(largest, decimals)} (${number(p99, decimals)})`;
}

function buildingRow(b) {
  const { factor, prefix } = scaled(b.force);
  const how = { obstacle: "counted by contact", pressure: "c \u03c1 v\u00b2 h b" }[b.force_from] ?? "";
  return [
    b.name,
    b.arrival === null ? "not reached" : number(b.arrival, 1),
    withPercentile(b.thickness, 2),
    withPercentile(b.speed, 1),
    withPercentile(b.pressure, 1),
    number(b.width, 1),
    `${number(b.force / factor, 2)} ${prefix}N`,
    how,
  ];
}

/** The section is dropped from a report without buildings. */
export function drawHazard(data) {
  const { buildings } = data.hazard;
  const section = document.getElementById("hazard-section");
  if (!buildings.length) {
    section.remove();
    document.querySelector('nav a[href="#hazard-section"]')?.remove();
    return;
  }
  const box = document.getElementById("hazard");
  box.append(
    table(
      "buildings-table",
      ["Building", "Arrival [s]", "Thickness [m]", "Speed [m/s]", "Pressure [kPa]", "Width [m]", "Force", "From"],
      buildings.map(buildingRow),
    ),
    h(
      "p",
      { class: "note" },
      "Largest value over time of the cells at a building, in brackets the 99th percentile of these cells. Force: " +
        "what contact counted where the building was an obstacle; else pressure times thickness times the largest " +
        "width of the footprint (Hungr et al. 1984), a bound, for the largest values need not come together.",
    ),
  );
}
