// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The page of an ensemble: reads its data and links map, charts and table.
import { h, number } from "../../report/page/format.js";
import { sample } from "../../report/page/lines.js";
import { ReportMap } from "../../report/page/map.js";
import { drawParameters, drawVersions } from "../../report/page/tables.js";
import { drawBudget } from "./budget.js";
import { called, callSlides, dropSampled, nameOf } from "./called.js";
import { columnTitle, valueWords } from "./columns.js";
import { MapPanel, readMaps } from "./map_panel.js";
import { mostDrawn, Outlines, styles } from "./outlines.js";
import { Parallel } from "./parallel.js";
import { drawPosterior } from "./posterior.js";
import { Histogram, Scatter } from "./scatter.js";
import { Selection } from "./selection.js";
import { Convergence, Sensitivity } from "./sensitivity.js";
import { MemberTable } from "./table.js";
import { drawMethod, drawSummary } from "./words.js";

function complain(words) {
  const box = document.getElementById("trouble");
  box.textContent = words;
  box.hidden = false;
}

/** Release and survey, as lines of the map. */
function fixedLines(data) {
  const { west, south } = data.map.window;
  const points = (flat) => {
    const list = [];
    for (let i = 0; i < flat.length; i += 2) list.push([flat[i] + west, flat[i + 1] + south]);
    return list;
  };
  const found = [];
  for (const [id, title] of [
    ["survey", data.run.survey],
    ["release", data.run.slides ? "Released" : "Release of the base recipe"],
  ])
    if (data.outlines[id].length) found.push({ id, title, style: styles[id], lines: data.outlines[id].map(points) });
  return found;
}

function makeOverlays(data, lines, map, outlines, selection) {
  const box = document.getElementById("overlays");
  const add = (id, title, style, toggle) => {
    const input = h("input", { type: "checkbox", id: `overlay-${id}`, checked: true });
    input.addEventListener("change", () => toggle(input.checked));
    box.append(h("label", {}, input, sample(style), title));
  };
  const part = (name) => (on) => {
    outlines.shown[name] = on;
    outlines.draw(selection);
  };
  add("spaghetti", `Flow of the ${called(data).many} kept`, { ...styles.spaghetti, opacity: 1 }, part("spaghetti"));
  box.append(h("label", { class: "note" }, sample(styles.flow), `Flow of the chosen ${called(data).one}`));
  add("deposit", `Deposit of the chosen ${called(data).one}`, styles.deposit, part("deposit"));
  for (const line of [...lines].reverse()) add(line.id, line.title, line.style, (on) => map.toggle(line.id, on));
}

function drawChosen(data, outlines, selection) {
  const box = document.getElementById("chosen"),
    { chosen } = selection;
  if (chosen === null) {
    box.replaceChildren(
      h("p", { class: "note" },
        `Choose a ${called(data).one} in a chart or in the table: its outline is drawn here.`),
    );
    return;
  }
  const rows = data.members.columns.map((column) =>
    h("div", {}, h("dt", {}, columnTitle(column)), h("dd", {}, valueWords(column, chosen))),
  );
  const state = data.members.states[chosen];
  const missing =
    state !== 1
      ? "It was not counted and has no outline."
      : outlines.has(chosen)
        ? null
        : `Its outline is not on this page, which holds the first ones; ${called(data).table} has its row.`;
  box.replaceChildren(
    h("h3", {}, nameOf(data, chosen)),
    missing ? h("p", { class: "note" }, missing) : "",
    h("dl", {}, rows),
  );
}

/** Buttons of the members that stand for the others. */
function drawMedoids(data, selection) {
  const { members, counts, of, mean_distance: distance } = data.medoids;
  const button = (member, i) => {
    const made = h("button", { type: "button", "data-member": member }, `${number(member)}`);
    made.addEventListener("click", () => selection.choose(member));
    return [made, ` (${number((100 * counts[i]) / of)} %)${i + 1 < members.length ? ", " : ". "}`];
  };
  if (!members.length) return;
  document
    .getElementById("medoids")
    .append(
      `Members that stand for ${of < data.run.counted ? `the first ${number(of)}` : "all"}, and for how many: `,
      ...members.flatMap(button),
      `Their footprints are nearest to the others (medoids; mean Jaccard distance ${number(distance, 2)}).`,
    );
}

function notes(data, outlines) {
  const { run, map } = data,
    parts = [`Coordinates: ${run.crs} [m].`, "Shading: surface before the failure."];
  if (map.coarsest > 1)
    parts.push(
      `Maps coarsened for this page, ${map.coarsest} \u00d7 ${map.coarsest} cells in one, of which the largest value ` +
        `is kept; the GeoTIFFs in ${data.run.slides ? "slides" : data.budget ? "budget" : "probability"}/ are whole.`,
    );
  const held = data.outlines.members.length;
  if (held < run.counted)
    parts.push(
      `The page holds the outlines of the first ${number(held)} of ${number(run.counted)} counted ` +
        `${called(data).many}.`,
    );
  if (held > mostDrawn) parts.push(`${mostDrawn} outlines are drawn at a time.`);
  parts.push("Click the map, then turn the wheel to zoom.");
  document.getElementById("map-note").textContent = parts.join(" ");
  const { all, shown } = data.members;
  document.getElementById("members-note").textContent =
    all > shown
      ? `The charts show the first ${number(shown)} of ${number(all)} ${called(data).many}; ` +
        `${called(data).table} has all.`
      : `All ${number(all)} ${called(data).many}; those that are not counted have no point and no line.`;
}

async function draw() {
  const data = JSON.parse(document.getElementById("data").textContent);
  if (!data.run.sampled) dropSampled();
  if (data.run.slides) callSlides();
  drawBudget(data);
  drawPosterior(data);
  drawSummary(data);
  drawMethod(data);
  drawParameters(data);
  drawVersions(data);
  const selection = new Selection(data.members);
  const charts = {
    ...(!data.run.sampled ? {} : { sensitivity: new Sensitivity(data), convergence: new Convergence(data) }),
    table: new MemberTable(data, selection),
    scatter: new Scatter(data, selection),
    histogram: new Histogram(data, selection),
    parallel: new Parallel(data, selection),
  };
  if (typeof DecompressionStream === "undefined") {
    complain("The maps of this page need a browser of 2023 or later (DecompressionStream). All else is complete.");
    return;
  }
  const fields = await readMaps(data.map),
    lines = fixedLines(data);
  const map = new ReportMap(document.getElementById("map"), data, fields, lines);
  const outlines = new Outlines(data.outlines, map.leaflet);
  makeOverlays(data, lines, map, outlines, selection);
  const panel = new MapPanel(data, fields, map);
  notes(data, outlines);
  drawMedoids(data, selection);
  const follow = () => {
    outlines.draw(selection);
    drawChosen(data, outlines, selection);
  };
  selection.onChange(follow);
  follow();
  window.ensemble = { data, fields, map, panel, outlines, selection, ...charts }; // for the console, and for the test
  document.documentElement.dataset.ready = "yes";
}

draw().catch((error) => {
  complain(`The page could not be drawn: ${error.message}`);
  throw error;
});
