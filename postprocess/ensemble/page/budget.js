// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How sure the recipe's run is: what each doubt does to the deposit. The data are those of budget.json.
import { h, number, quantity } from "../../report/page/format.js";

/** "+12", "\u22123": a change with its sign. */
function signed(value, decimals) {
  const words = number(value, decimals);
  return value > 0 && Number(value.toFixed(decimals)) !== 0 ? `+${words}` : words;
}

/** Per cent, with the digits that their size is worth. */
function percent(value) {
  return `${number(value, value < 10 ? 1 : 0)}\u2009%`;
}

/** Scores that have a column here, and its heading; budget.csv has the others too. */
const shownScores = {
  footprint_csi: "Footprint CSI",
  footprint_csi_by_cells: "Footprint CSI, by cells",
  deposit_csi: "Deposit CSI",
  deposit_csi_outside_release: "Deposit CSI, outside the release",
  thickness_rmse_m: "RMSE [m]",
  thickness_rmse_outside_release_m: "RMSE outside the release [m]",
};

const isDone = (line) => line.state === "counted";
const known = (value, words) => (value === null || value === undefined ? "\u2013" : words(value));
const cell = (words) => h("td", { class: "number" }, words);
const scoreCells = (budget, line) =>
  Object.keys(shownScores)
    .filter((key) => key in budget.own)
    .map((key) => cell(known(line[key], (value) => number(value, 2))));
const timeCell = (line) => cell(quantity(line.wall_time_s, "s", line.wall_time_s < 10 ? 1 : 0));

/** A bar as long as the share is of the largest, behind its number. */
function shareCell(line, largest) {
  const width = largest > 0 ? (100 * line.deposit_elsewhere_percent) / largest : 0;
  const bar = h("span", { class: `budget-bar ${line.kind}`, style: `width: ${width.toFixed(1)}%` });
  const track = h("span", { class: "budget-track" }, bar);
  return h("td", { class: "budget-share" }, track, h("b", {}, percent(line.deposit_elsewhere_percent)));
}

function lineRow(line, budget, largest) {
  const what = h(
    "td",
    {},
    h(
      "div", // one box, which narrow screens set beside the heading
      {},
      line.title.charAt(0).toUpperCase() + line.title.slice(1),
      h("span", { class: `budget-kind ${line.kind}` }, line.kind === "physical" ? "slide" : "computation"),
      h("div", { class: "note" }, line.what),
      line.warnings ? h("div", { class: "note" }, `Warning: ${line.warnings}`) : "",
    ),
  );
  const scores = scoreCells(budget, line);
  if (!isDone(line)) {
    const why = `${line.state.charAt(0).toUpperCase()}${line.state.slice(1)}: ${line.reason}`;
    return h("tr", {}, what, h("td", { class: "plain", colspan: 5 + scores.length }, why));
  }
  return h(
    "tr",
    { "data-run": line.run },
    what,
    shareCell(line, largest),
    cell(known(line.run_out_change_m, (change) =>
      `${signed(change, 0)}\u2009m (${signed(line.run_out_change_percent, 1)}\u2009%)`)),
    cell(known(line.footprint_overlap, (overlap) => number(overlap, 3))),
    cell(`${signed(line.largest_speed_change_m_s, 1)}\u2009m/s`),
    ...scores,
    timeCell(line),
  );
}

function ownRow({ own }) {
  return h(
    "tr",
    { class: "changed" },
    h("td", {}, "The recipe itself"),
    h("td", {}, ""),
    cell(known(own.run_out_m, (runOut) => quantity(runOut, "m"))),
    cell(""),
    cell(quantity(own.largest_speed_m_s, "m/s", 1)),
    ...scoreCells({ own }, own),
    timeCell(own),
  );
}

/** The largest of a kind in a sentence; empty where none was compared. */
function largestWords(lines, kind, words) {
  const found = lines.find((line) => isDone(line) && line.kind === kind);
  return found ? `${words}: ${found.title}, ${percent(found.deposit_elsewhere_percent)}.` : "";
}

function budgetTable(budget, threshold) {
  const largest = Math.max(0, ...budget.rows.filter(isDone).map((line) => line.deposit_elsewhere_percent));
  const heads = [
    `Run-out > ${threshold} m`,
    "Overlap",
    "Speed",
    ...Object.keys(shownScores).filter((key) => key in budget.own).map((key) => shownScores[key]),
    "Time",
  ];
  const head = [
    h("th", {}, "Doubt"),
    h("th", {}, "Deposit elsewhere"),
    ...heads.map((words) => h("th", { class: "number" }, words)),
  ];
  return h(
    "div",
    { class: "scroll" },
    h(
      "table",
      { class: "data", id: "budget-table" },
      h("thead", {}, h("tr", {}, head)),
      h("tbody", {}, ownRow(budget), budget.rows.map((line) => lineRow(line, budget, largest))),
    ),
  );
}

/** The section is dropped from the page of another ensemble. */
export function drawBudget(data) {
  const { budget } = data;
  if (!budget) {
    document.getElementById("budget-section").remove();
    document.querySelector('nav a[href="#budget-section"]').remove();
    return;
  }
  const said = [
    largestWords(budget.rows, "physical", "Largest doubt about the slide"),
    largestWords(budget.rows, "numerical", "Largest doubt about the computation"),
  ];
  document.getElementById("budget").append(
    h("p", { class: "prose" }, said.filter(Boolean).join(" ")),
    budgetTable(budget, data.run.threshold),
    h(
      "p",
      { class: "note prose" },
      "Each line is a run that differs from the recipe itself in one thing. Deposit elsewhere: share of the volume " +
        "of the recipe\u2019s deposit that lies in other cells in the other run, volumes set equal; doubts are about " +
        "the slide (brown) or about the computation (blue). Run-out and largest speed: other run less the " +
        "recipe\u2019s. Overlap: footprint of both over footprint of either. Time: wall time, runs beside one " +
        "another. Doubts of several lines need not add up, and what no line asks about is not in this table. The " +
        "map shows where the deposit differs.",
    ),
  );
}
