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

/** A bar as long as the share is of the largest, behind its number. */
function shareCell(line, largest) {
  const width = largest > 0 ? (100 * line.elsewhere) / largest : 0;
  const bar = h("span", { class: `budget-bar ${line.kind}`, style: `width: ${width.toFixed(1)}%` });
  return h("td", { class: "budget-share" }, h("span", { class: "budget-track" }, bar), h("b", {}, percent(line.elsewhere)));
}

function lineRow(line, budget, largest) {
  const cell = (words) => h("td", { class: "number" }, words);
  const runOut = line.run_out - budget.run_out;
  const what = h("td", {}, line.title, h("div", { class: "note" }, line.words));
  if (!line.done) {
    const why = `${line.failed ? "Failed" : "Left out"}: ${line.reason}`;
    return h("tr", {}, what, h("td", {}, line.kind), h("td", { class: "plain", colspan: 5 + budget.scores.length }, why));
  }
  return h(
    "tr",
    { "data-run": line.name },
    what,
    h("td", {}, line.kind),
    shareCell(line, largest),
    cell(
      budget.run_out === null || line.run_out === null
        ? "\u2013"
        : `${signed(runOut, 0)}\u2009m (${signed((100 * runOut) / budget.run_out, 1)}\u2009%)`,
    ),
    cell(line.overlap === null ? "\u2013" : number(line.overlap, 3)),
    cell(`${signed(line.speed - budget.speed, 1)}\u2009m/s`),
    ...line.scores.map((score, i) => cell(score === null ? "\u2013" : number(score, budget.scores[i].decimals))),
    cell(`${number(line.steps)} in ${quantity(line.seconds, "s", line.seconds < 10 ? 1 : 0)}`),
  );
}

function ownRow(budget) {
  const cell = (words) => h("td", { class: "number" }, words);
  return h(
    "tr",
    { class: "changed" },
    h("td", {}, "This run"),
    h("td", {}, ""),
    h("td", {}, ""),
    cell(budget.run_out === null ? "\u2013" : quantity(budget.run_out, "m")),
    cell(""),
    cell(quantity(budget.speed, "m/s", 1)),
    ...budget.scores.map((score) => cell(number(score.own, score.decimals))),
    cell(`${number(budget.steps)} in ${quantity(budget.seconds, "s", budget.seconds < 10 ? 1 : 0)}`),
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
    "Footprint overlap",
    "Largest speed",
    ...budget.scores.map((score) => score.label),
    "Steps, time",
  ];
  const head = [
    h("th", {}, "Doubt"),
    h("th", {}, "Kind"),
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
        "run\u2019s deposit that lies in other cells in the other run, volumes set equal. Run-out and speed: other " +
        "run less this one. Overlap: footprint of both over footprint of either. Doubts of several lines need not " +
        "add up, and what no line asks about is not in this table. The layers \u201cSpread\u201d of the map show " +
        "where the deposit differs.",
    ),
  );
}
