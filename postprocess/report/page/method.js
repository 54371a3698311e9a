// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Method and its limits, in words that follow the parameters used.
import { h } from "./format.js";
import { steps } from "./words.js";

/** Looks a parameter up; texts without their quotes, undefined where it is not known. */
export function parameters(data) {
  return (table, key) => {
    for (const stage of data.stages) {
      const found = stage.keys.find((k) => k.table === table && k.key === key);
      if (found) return found.value.replace(/^"(.*)"$/, "$1");
    }
    return undefined;
  };
}

function solver(data) {
  const get = parameters(data);
  if (get("solve", "integrator") === undefined)
    return [h("p", { class: "missing" }, "What talus-solve used is not known: its solve.used.toml is missing.")];
  const grid =
    get("solve", "mapping") === "cartesian"
      ? "a Cartesian background grid"
      : "a background grid that follows the terrain";
  const { material, bed } = data.run;  // words of the laws, from the solver
  const reference =
    get("solve", "preset") === "reference"
      ? " The preset \u201creference\u201d keeps to the published implicit scheme."
      : "";
  return [
    h(
      "p",
      {},
      `The failing mass is computed in three dimensions by the material point method (Sulsky, Zhou & Schreyer ` +
        `1995) on ${grid}, ` +
        `in ${steps(get)}, with ${get("solve", "shape")} shape functions. It is ${material}; at its bed acts ` +
        `${bed}.${reference}`,
    ),
  ];
}

function maps(data) {
  const { thresholds, map } = data.run;
  const words = [
    `Maps have cells of ${map.cell} m. Thickness is released volume over the area of a cell, vertical. Speed is ` +
      `the mean over the depth of a column, pressure ` +
      `density times its square; both, and the arrival time, count where the flow is thicker than ${thresholds.map} m.`,
  ];
  if (data.map.coarsest > 1) {
    words.push(
      `To keep this page small its maps are coarser than the files beside it: up to ${data.map.coarsest} \u00d7 ` +
        `${data.map.coarsest} cells are made one ` +
        "(mean of thickness and differences, largest of peaks, first of arrivals).",
    );
  }
  return [h("p", {}, words.join(" "))];
}

const limits = [
  "The result is as good as its inputs: release volume, friction and terrain dominate the error. One run is one " +
    "scenario, not a hazard map; no frequency and no safety margin is in it.",
  "Friction and strength are often fitted to the very event they are scored on. A good score then shows that the " +
    "model can describe the event, not that it would have predicted it.",
  "No water flows on its own and no fragmentation is resolved: pore pressure, where used, is a fixed share of the " +
    "pressure. Air resistance is left out.",
  "Features below about two cells are not resolved; edges of deposits are known to about one cell.",
  "Impact pressure is that of the free flow, density times speed squared. Loads on structures need their own " +
    "assessment.",
];

const sources = [
  "Sulsky, Zhou & Schreyer 1995, Comput. Phys. Commun. 87, 236.",
  "Jiang et al. 2015, ACM Trans. Graph. 34(4), 51.",
  "Steffen, Kirby & Berzins 2008, Int. J. Numer. Meth. Eng. 76, 922.",
  "Charlton, Coombs & Augarde 2017, Comput. Struct. 190, 108.",
  "Lucas, Mangeney & Ampuero 2014, Nat. Commun. 5, 3417.",
  "Heidke 1926, Geogr. Ann. 8, 301.",
];

export function drawMethod(data) {
  document.getElementById("method").append(
    h(
      "div",
      { class: "prose" },
      solver(data),
      maps(data),
      h("h3", {}, "Limits"),
      h(
        "ul",
        { class: "plain-list" },
        limits.map((words) => h("li", {}, words)),
      ),
      h("h3", {}, "Sources"),
      h("p", { class: "note" }, sources.join(" ")),
    ),
  );
}
