// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How sure the run is: what each doubt does to the deposit.
import { h, number, quantity } from "./format.js";

/** "+12", "\u22123": a change with its sign. */
function signed(value, decimals) {
  const words = number(value, decimals);
  return value > 0 && Number(value.toFixed(decimals)) !== 0 ? `+${words}` : words;
}

/** A share as per cent, with the digits that its size is worth. */
function percent(share) {
  return `${number(100 * share, share < 0.1 ? 1 : 0)}\u2009%`;
}

/** Scores that have a column here, and its heading; budget.csv has the others too. */
const shownScores = { footprint_csi: "Footprint CSI", deposit_csi: "Deposit CSI", thickness_rmse_m: "RMSE [m]" };

/** A bar as long as the share is of the largest, behind its number. */
function shareCell(line, largest) {
  const width = largest > 0 ? (100 * line.elsewhere) / largest : 0;
  const bar = h("span", { class: `budget-bar ${line.kind}`, style: `width: ${width.toFixed(1)}%` });
  const track = h("span", { class: "budget-track" }, bar);
  return h("td", { class: "budget-share" }, track, h("b", {}, percent(line.elsewhere)));
}

/** The scores that have a column, with their place among all. */
function scoresOf(budget) {
  return budget.scores.map((score, place) => ({ score, place })).filter(({ score }) => score.key in shownScores);
}

function lineRow(line, budget, largest) {
  const cell = (words) => h("td", { class: "number" }, words);
  const runOut = line.run_out - budget.run_out;
  const kind = line.kind === "physical" ? "slide" : "computation";
  const what = h(
    "td",
    {},
    h(
      "div", // one box, which narrow screens set beside the heading
      {},
      line.title.charAt(0).toUpperCase() + line.title.slice(1),
      h("span", { class: `budget-kind ${line.kind}` }, kind),
      h("div", { class: "note" }, line.words),
      line.accepted ? h("div", { class: "note" }, `Accepted: ${line.accepted}`) : "",
      ...line.warnings.map((words) => h("div", { class: "note" }, `Warning: ${words}`)),
    ),
  );
  if (!line.done) {
    const why = `${line.failed ? "Failed" : "Left out"}: ${line.reason}`;
    return h("tr", {}, what, h("td", { class: "plain", colspan: 5 + scoresOf(budget).length }, why));
  }
  return h(
    "tr",
    { "data-run": line.name },
    what,
    shareCell(line, largest),
    cell(
      budget.run_out === null || line.run_out === null
        ? "\u2013"
        : `${signed(runOut, 0)}\u2009m (${signed((100 * runOut) / budget.run_out, 1)}\u2009%)`,
    ),
    cell(line.overlap === null ? "\u2013" : number(line.overlap, 3)),
    cell(`${signed(line.speed - budget.speed, 1)}\u2009m/s`),
    ...scoresOf(budget).map(({ score, place }) =>
      cell(line.scores[place] === null ? "\u2013" : number(line.scores[place], score.decimals)),
    ),
    cell(quantity(line.seconds, "s", line.seconds < 10 ? 1 : 0)),
  );
}

function ownRow(budget) {
  const cell = (words) => h("td", { class: "number" }, words);
  return h(
    "tr",
    { class: "changed" },
    h("td", {}, "This run"),
    h("td", {}, ""),
    cell(budget.run_out === null ? "\u2013" : quantity(budget.run_out, "m")),
    cell(""),
    cell(quantity(budget.speed, "m/s", 1)),
    ...scoresOf(budget).map(({ score }) => cell(number(score.own, score.decimals))),
    cell(quantity(budget.seconds, "s", budget.seconds < 10 ? 1 : 0)),
  );
}

/** The largest of a kind in a sentence; empty where none was compared. */
function largestWords(lines, kind, words) {
  const found = lines.find((line) => line.done && line.kind === kind);
  return found ? `${words}: ${found.title}, ${percent(found.elsewhere)}.` : "";
}

function budgetTable(budget) {
  const largest = Math.max(0, ...budget.lines.filter((line) => line.done).map((line) => line.elsewhere));
  const heads = [
    "Run-out",
    "Overlap",
    "Speed",
    ...scoresOf(budget).map(({ score }) => shownScores[score.key]),
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
      h("tbody", {}, ownRow(budget), budget.lines.map((line) => lineRow(line, budget, largest))),
    ),
  );
}

/** The section is dropped from the report of a run without a budget. */
export function drawBudget(data) {
  const { budget } = data;
  if (!budget) {
    document.getElementById("budget-section").remove();
    document.querySelector('nav a[href="#budget-section"]')?.remove();
    return;
  }
  const said = [
    largestWords(budget.lines, "physical", "Largest doubt about the slide"),
    largestWords(budget.lines, "numerical", "Largest doubt about the computation"),
  ];
  document.getElementById("budget").append(
    h("p", { class: "prose" }, said.filter(Boolean).join(" ")),
    budgetTable(budget),
    h(
      "p",
      { class: "note prose" },
      "Each line is a run that differs from this one in one thing. Deposit elsewhere: share of the volume of this " +
        "run\u2019s deposit that lies in other cells in the other run, volumes set equal; doubts are about the slide " +
        "(brown) or about the computation (blue). Run-out and largest speed: other run less this one. Overlap: " +
        "footprint of both over footprint of either. Time: wall time, runs beside one another. Doubts of several " +
        "lines need not add up, and what no line asks about is not in this table. The layers \u201cSpread\u201d of " +
        "the map show where the deposit differs.",
    ),
  );
}
