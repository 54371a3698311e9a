// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page says in words: headline, key numbers, method.
import { h, number } from "../../report/page/format.js";
import { called } from "./called.js";
import { columnNumber, columnTitle } from "./columns.js";
import { standardError } from "./map_panel.js";

const designs = {
  posterior: "a calibration with the survey",
  sobol: "Sobol\u2019s sequence",
  "latin-hypercube": "a Latin hypercube",
  "optimal-latin-hypercube": "an optimised Latin hypercube",
  "monte-carlo": "independent draws",
  "full-grid": "a full grid",
  "one-at-a-time": "one key at a time",
  sensitivity: "a design for Sobol indices",
  table: "a table",
  budget: "single changes of the recipe",
};

function quantile(values, share) {
  const sorted = values.filter((value) => value !== null).sort((a, b) => a - b);
  return sorted.length ? sorted[Math.min(sorted.length - 1, Math.floor(share * sorted.length))] : NaN;
}

function keyNumber(title, words, spread) {
  const below = spread ? h("span", { class: "spread" }, ...[spread].flat()) : null;
  return h("div", {}, h("dt", {}, title), h("dd", {}, words, below));
}

const keyResults = ["run_out_m", "reach_ratio", "flow_area_m2", "deposit_area_m2", "largest_speed_m_s",
  "volume_outflow_m3", "footprint_csi", "footprint_csi_by_cells"];

export function drawSummary(data) {
  const { run, members } = data;
  document.getElementById("title").textContent = run.title;
  const inputs = members.columns.filter((column) => column.kind === "input").map((column) => columnTitle(column));
  const { many } = called(data);
  const parts = [`${number(run.counted)} of ${number(run.members)} ${many} are counted`];
  if (run.failed) parts.push(`${number(run.failed)} failed and are left out`);
  if (run.waiting) parts.push(`${number(run.waiting)} have not been run`);
  if (!run.sampled) inputs.splice(0, 1); // the name
  if (run.elevation_error) inputs.push(run.elevation_error);
  const prior = run.prior ? ` Source of the friction: ${run.prior}.` : "";
  const varied = (inputs.length ? ` What varies: ${inputs.join(", ")}.` : "") + prior;
  document.getElementById("headline").textContent =
    run.slides
      ? `${parts.join(", ")}, each in a domain of its own over one elevation model.${varied}`
      : `${parts.join(", ")}. They were drawn by ${designs[run.design] ?? run.design}.${varied}`;
  const edge = run.at_edge ? h("strong", {}, ` At the edge of the domain: ${run.at_edge}.`) : "";
  const warned = run.members_warned
    ? h("strong", {}, ` ${number(run.members_warned)} of them warn of something, which stands at the end of this page.`)
    : "";
  document.getElementById("headline").append(edge, warned);
  const by = run.institution ? `${run.institution} \u00b7 ` : "";
  document.getElementById("byline").textContent = `${by}${run.made} \u00b7 Talus ${run.version}`;
  const box = document.getElementById("key-numbers");
  const counted = `${number(run.counted)} of ${number(run.members)}`;
  box.append(keyNumber(run.slides ? "Slides counted" : "Members counted", counted,
    run.failed ? `${number(run.failed)} failed` : null));
  const error = `\u00b1${number(100 * standardError(0.5, run.draws), 1)} %`;
  if (run.sampled) box.append(keyNumber("Error of a probability", error,
    "of one half, one sigma"));
  for (const { of, held, csi, brier } of run.share_scores)
    box.append(keyNumber(`Surveyed ${of} at more than 5 %`, `${number(100 * held, 1)} %`,
      `more than half: CSI ${number(csi, 3)}; Brier score ${number(brier, 3)}`));
  for (const name of keyResults) {
    const column = members.columns.find((one) => one.name === name);
    if (!column || !column.values.some((value) => value !== null)) continue;
    const of = (share) => columnNumber(column, quantile(column.values, share)),
      whole = (text) => h("span", {}, text);
    box.append(keyNumber(columnTitle(column), of(0.5), ["90 %: ", whole(of(0.05)), " to ", whole(of(0.95))]));
  }
}

function item(...words) {
  return h("li", {}, ...words);
}

function slideMethod(run) {
  return [
    item("Each slide is a whole run of the model, by itself, in the part of the elevation model around it. Slides do "
      + "not meet: where two come to a place, each comes alone."),
    item("A map of largest values has, in each cell, the largest of any slide; a number of slides counts those that "
      + "pass the threshold. They are no probability: nothing says how likely a slide is."),
    item("A slide that came to the edge of its domain is named: what lies beyond is missing from maps and numbers."),
    item(`Outlines are of cells that were thicker than ${run.threshold} m.`),
  ];
}

function budgetMethod(run) {
  return [
    item("Every member is a whole run of the model. Each but the first, which is the recipe itself, differs from it in "
      + "one thing; what the recipe leaves to the program is settled once, for all of them."),
    item("A map of spread has, in each cell, the largest less the smallest thickness of the deposit over these runs. "
      + "It is no probability."),
    item(`Outlines are of cells that were thicker than ${run.threshold} m; of a run on other cells, by the centres of `
      + "these cells."),
  ];
}

export function drawMethod(data) {
  const { run } = data,
    box = document.getElementById("method");
  const list = h("ul", { class: "plain-list" });
  if (run.slides) list.append(...slideMethod(run));
  else if (data.budget) list.append(...budgetMethod(run));
  else list.append(
    item(run.share.meaning),
    item(`${run.share.error} It is half the width of Wilson\u2019s score interval at one sigma, which is not zero `
      + "where no member came."),
    item("Every member is a whole run of the model; nothing between the members is interpolated."),
    item("What varies, and how, is the analyst\u2019s choice: a probability here is one of the model with these "
      + "distributions, not of nature. What does not vary is taken as known."),
    item("Mean and standard deviation count a member that did not reach a cell as 0 there; times are over the members "
      + "that arrive. Quantiles come from histograms whose bins grow by 16 to 20 %, linear within a bin."),
    item(`Outlines are of cells that were thicker than ${run.threshold} m.`),
    item("The volume beyond a line is not among the results: the runs keep counts and footprints, not their maps."),
  );
  if (run.survey) list.append(item(`Scores of members are against ${run.survey}, as the report of a run has them.`));
  if (run.hazard) list.append(item(`Hazard class: ${run.hazard}.`));
  for (const words of run.warnings) list.append(item(h("strong", {}, "Warning: "), `${words}.`));
  for (const [name, why] of run.accepted)
    list.append(item(h("strong", {}, `Insisted on, "${name}": `), why));
  box.append(list);
  const listWords = (title, words, all) => {
    if (!words.length) return;
    box.append(h("h3", {}, title));
    box.append(h("ul", { class: "plain-list note" }, words.map(([name, what]) => item(`${name}: ${what}`))));
    if (all > words.length)
      box.append(h("p", { class: "note" }, `The first ${words.length} of ${all}; ${called(data).table} has all.`));
  };
  const of = run.slides ? "Slides" : "Members";
  listWords(`${of} that failed`, run.failures, run.failed);
  listWords(`What ${of.toLowerCase()} warn of`, run.warnings_of_members, run.warnings_in_all);
}
