// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The lines of the map: what they are called, how they look, where they run. Shared by the map and the printed plates.

/** Styles: colour, width and dashes of the line, width of the white casing below it. */
const styles = {
  contours: { title: "Contours", colour: "#545c66", width: 0.8, opacity: 0.45 },
  footprint: { title: "Simulated footprint", colour: "#1f1f24", width: 1.3, casing: 2.6 },
  survey_footprint: { title: "footprint", colour: "#004db3", width: 1.3, dashes: [4, 3], casing: 2.6 },
  survey_deposit: { title: "deposit", colour: "#004db3", width: 2.4, dashes: [9, 5], casing: 4.4 },
  release: { title: "Release", colour: "#00735c", width: 2.2, casing: 4 },
  reach: { title: "Angle of reach", colour: "#8c1a8c", width: 1.8, dashes: [6, 4], casing: 3.2 },
  buildings: { title: "Buildings", colour: "#1a1a1a", width: 1.6, casing: 3 },
  thalweg: { title: "Thalweg", colour: "#8c1a73", width: 2, dashes: [7, 3, 2, 3], casing: 3.4 },
};

/** Lists of [[x, y], ...] in map coordinates. */
function unflatten(flat, window) {
  const points = [];
  for (let i = 0; i < flat.length; i += 2) points.push([flat[i] + window.west, flat[i + 1] + window.south]);
  return points;
}

function title(id, data) {
  const { run, map } = data,
    survey = run.survey;
  if (id === "contours") return `Contours every ${map.lines.contours.interval} m`;
  if (id === "footprint") return `Simulated: peak > ${run.thresholds.footprint} m`;
  if (id === "survey_deposit") return `${survey.name}: deposit > ${run.thresholds.deposit} m`;
  if (id === "survey_footprint") {
    const what = survey.is_polygon
      ? "outline"
      : `${survey.is_change ? "|change|" : "peak"} > ${survey.footprint_threshold} m`;
    return `${survey.name}: ${what}`;
  }
  return styles[id].title;
}

/** [{id, title, style, lines}], bottom first. */
export function mapLines(data) {
  const { lines, window } = data.map,
    found = [];
  const add = (id, list) => {
    const points = list.filter((flat) => flat.length >= 4).map((flat) => unflatten(flat, window));
    if (points.length) found.push({ id, title: title(id, data), style: styles[id], lines: points });
  };
  add(
    "contours",
    lines.contours.levels.flatMap((level) => level.lines),
  );
  add("footprint", lines.footprint);
  add("survey_footprint", lines.survey_footprint ?? []);
  add("survey_deposit", lines.survey_deposit ?? []);
  add("release", lines.release);
  for (const id of ["reach", "buildings"]) add(id, lines[id] ?? []);
  add("thalweg", [lines.thalweg]);
  return found;
}

/** A sample of a style for the legend. */
export function sample(style, width = 30) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  svg.setAttribute("width", width);
  svg.setAttribute("height", 10);
  const line = document.createElementNS("http://www.w3.org/2000/svg", "line");
  const attributes = {
    x1: 0,
    x2: width,
    y1: 5,
    y2: 5,
    stroke: style.colour,
    "stroke-width": style.width + 0.4,
    "stroke-dasharray": (style.dashes ?? []).join(" "),
    "stroke-opacity": style.opacity ?? 1,
  };
  for (const [name, value] of Object.entries(attributes)) line.setAttribute(name, value);
  svg.append(line);
  return svg;
}
