// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The report: reads its data and fills the page.
import { readMap } from "./decode.js";
import { drawProfile, drawSeries } from "./curves.js";
import { drawHazard } from "./hazard.js";
import { mapLines } from "./lines.js";
import { ReportMap } from "./map.js";
import { drawMethod } from "./method.js";
import { Panel } from "./panel.js";
import { drawPlaceList, placesOf } from "./places.js";
import { Plates } from "./plates.js";
import { Relief } from "./relief.js";
import { labelCells } from "./stack.js";
import { drawSummary } from "./summary.js";
import { drawSurveys } from "./surveys.js";
import { drawFindings, drawInputs, drawParameters, drawScores, drawVersions, drawVolumes } from "./tables.js";

function complain(words) {
  const box = document.getElementById("trouble");
  box.textContent = words;
  box.hidden = false;
}

function mapNote(data) {
  const { run, map } = data,
    parts = [`Coordinates: ${run.crs} [m].`, "Shading: surface before the failure."];
  if (map.coarsest > 1)
    parts.push(
      `Maps coarsened for this page, up to ${map.coarsest} \u00d7 ${map.coarsest} cells in one; the GeoTIFFs ` +
        `beside it are whole.`,
    );
  parts.push("Click the map, then turn the wheel to zoom.");
  document.getElementById("map-note").textContent = parts.join(" ");
}

async function drawMaps(data) {
  const fields = await readMap(data.map),
    lines = mapLines(data),
    places = placesOf(data);
  const map = new ReportMap(document.getElementById("map"), data, fields, lines);
  if (places.length) map.addPlaces(places);
  const panel = new Panel(data, fields, map, lines, places);
  mapNote(data);
  new Plates(data, fields, map, { lines, places }).draw();
  return { map, panel, relief: new Relief(data, fields, map, lines) };
}

/** Tells the map which vertex of the profile is looked at. */
function thalwegPointer(data, view) {
  const flat = data.map.lines.thalweg,
    { west, south } = data.map.window;
  return (i) => view.map?.point(i === undefined ? null : [flat[2 * i] + west, flat[2 * i + 1] + south]);
}

async function draw() {
  const data = JSON.parse(document.getElementById("data").textContent),
    view = {};
  drawSummary(data);
  drawPlaceList(data);
  drawFindings(data);
  drawScores(data);
  drawHazard(data);
  drawSurveys(data);
  drawVolumes(data);
  drawInputs(data);
  drawParameters(data);
  drawMethod(data);
  drawVersions(data);
  labelCells(document);
  drawProfile(data, thalwegPointer(data, view));
  drawSeries(data);
  if (typeof DecompressionStream === "undefined") {
    complain(
      "The maps of this report need a browser of 2023 or later (DecompressionStream). All numbers below are complete.",
    );
    return;
  }
  Object.assign(view, await drawMaps(data));
  window.report = { data, ...view }; // for looking at from the console, and for the test
  document.documentElement.dataset.ready = "yes";
}

draw().catch((error) => {
  complain(`The report could not be drawn: ${error.message}`);
  throw error;
});
