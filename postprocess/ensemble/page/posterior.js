// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Draws of a calibration beside those of their distributions before it: a table, conclusions and a corner plot.
import { colours } from "../../report/page/charts.js";
import { h, number } from "../../report/page/format.js";
import { columnTitle } from "./columns.js";

const before = "#9aa3ad", bins = 20, side = 150, gap = 8, left = 64, below = 46;

function svg(name, attributes, ...children) {
  const element = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
}

const digits = ({ low, high }) => Math.max(0, Math.ceil(2 - Math.log10(high - low || 1)));

/** A key with its draws before and after, and the range that holds them. */
function drawnKeys(data) {
  const { prior, summary } = data.calibration;
  return summary.keys.flatMap((row) => {
    const column = data.members.columns.find(({ name }) => name === row.key);
    if (!column || column.words.length) return [];
    const after = column.values.filter((_, member) => data.members.states[member] === 1);
    const all = [...prior[row.key], ...after].filter(Number.isFinite);
    return [
      {
        ...row,
        name: columnTitle(column),
        draws: [prior[row.key], after],
        low: Math.min(...all),
        high: Math.max(...all),
      },
    ];
  });
}

function table({ summary }) {
  const three = (list) => {
    const decimals = digits({ low: list[0], high: list[2] });
    return list.map((value) => h("td", { class: "number" }, number(value, decimals)));
  };
  const head = h("tr", {}, h("th", {}, "Key"), h("th", { colspan: 3, class: "number" }, "Before: 5, 50, 95 %"),
    h("th", { colspan: 3, class: "number" }, "After: 5, 50, 95 %"), h("th", { class: "number" }, "Deviation left"));
  const rows = summary.keys.map((row) =>
    h("tr", {}, h("td", {}, row.key), ...three(row.before), ...three(row.after),
      h("td", { class: "number" }, `${number(100 * row.left)} %`)));
  return h("div", { class: "scroll" }, h("table", { class: "data" }, h("thead", {}, head), h("tbody", {}, rows)));
}

const place = (key, value) => ((value - key.low) / (key.high - key.low || 1)) * side;

/** Bars of the draws after, a line of those before, each by its share. */
function histogram(key) {
  const shares = key.draws.map((draws) => {
    const counts = new Array(bins).fill(0);
    for (const value of draws)
      counts[Math.min(bins - 1, Math.floor((place(key, value) / side) * bins))] += 1 / draws.length;
    return counts;
  });
  const most = Math.max(...shares.flat()), width = side / bins, height = (share) => (share / most) * side * 0.95;
  const bars = shares[1].map((share, i) =>
    svg("rect", { x: i * width, y: side - height(share), width, height: height(share), fill: colours.blue }));
  const steps = shares[0].map((share, i) => {
    const y = side - height(share);
    return `${i * width},${y} ${(i + 1) * width},${y}`;
  });
  return [...bars, svg("polyline", { points: steps.join(" "), fill: "none", stroke: before, "stroke-width": 1.5 })];
}

function cloud(across, up) {
  return [before, colours.blue].flatMap((fill, which) =>
    across.draws[which].map((value, i) =>
      svg("circle", { cx: place(across, value), cy: side - place(up, up.draws[which][i]), r: 1.6, fill,
        "fill-opacity": which ? 0.7 : 0.45 })));
}

function label(words, x, y, anchor, turned) {
  const turn = turned ? { transform: `rotate(-90 ${x} ${y})` } : {};
  return svg("text", { x, y, "text-anchor": anchor, "font-size": 11, ...turn }, words);
}

function cornerPlot(keys) {
  const size = keys.length * (side + gap), parts = [];
  keys.forEach((up, row) =>
    keys.slice(0, row + 1).forEach((across, column) => {
      const x = left + column * (side + gap), y = row * (side + gap) + gap;
      const frame = svg("rect", { width: side, height: side, fill: "none", stroke: "#c9ced4" });
      const inside = row === column ? histogram(up) : cloud(across, up);
      parts.push(svg("g", { transform: `translate(${x} ${y})` }, frame, ...inside));
      if (row + 1 === keys.length) {
        parts.push(label(number(across.low, digits(across)), x, y + side + 14, "start"),
          label(number(across.high, digits(across)), x + side, y + side + 14, "end"),
          label(across.name, x + side / 2, y + side + 32, "middle"));
      }
      if (column === 0 && row > 0) {
        parts.push(label(number(up.low, digits(up)), x - 4, y + side, "end"),
          label(number(up.high, digits(up)), x - 4, y + 10, "end"),
          label(up.name, x - 46, y + side / 2, "middle", true));
      }
    }));
  const width = left + size, height = size + below;
  const plot = svg("svg", { viewBox: `0 0 ${width} ${height}`, width, height, role: "img" }, ...parts);
  plot.setAttribute("aria-label", "Draws of each key and of each pair of keys");
  return plot;
}

export function drawPosterior(data) {
  if (!data.calibration) {
    document.getElementById("posterior-section").remove();
    document.querySelector('a[href="#posterior-section"]').remove();
    return;
  }
  const keys = drawnKeys(data), { conclusions } = data.calibration.summary;
  document.getElementById("posterior").append(
    table(data.calibration),
    h("ul", {}, conclusions.map((words) => h("li", {}, words))),
    h("p", { class: "note" }, "Grey: draws of the distributions before the survey. Blue: draws after it."),
    h("div", { class: "scroll" }, cornerPlot(keys)));
}
