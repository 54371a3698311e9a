// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scores, volumes, inputs, parameters, versions.
import { area, h, number, quantity, unitWords, volume } from "./format.js";
import { definition } from "./words.js";

/** "thickness_rmse_sd_m" tells the spread of "thickness_rmse_m": {base, what}; null for what stands by itself. */
function spreadOf(key) {
  const found = /^(.*)_(sd|p05|p95)(_[a-z0-9_]+)?$/.exec(key);
  return found && { base: found[1] + (found[3] ?? ""), what: found[2] };
}

/** Sections with their entries as {entry, sd, p05, p95}: a spread, wherever it stands, goes to what it is the spread
 * of. What has no such entry stays an entry of its own; sections left empty are dropped. */
export function scoreSections(score) {
  const sections = score.sections.map((s) => ({ title: s.title, items: s.entries.map((entry) => ({ entry })) }));
  const byKey = new Map(sections.flatMap((s) => s.items.map((item) => [item.entry.key, item])));
  for (const section of sections) {
    section.items = section.items.filter(({ entry }) => {
      const spread = spreadOf(entry.key),
        base = spread && byKey.get(spread.base);
      if (base) base[spread.what] = entry.value;
      return !base;
    });
  }
  return sections.filter((section) => section.items.length);
}

/** "0.87 ± 0.02", and in brackets where 90 of 100 lie. */
export function scoreWords({ entry, sd, p05, p95 }) {
  if (typeof entry.value === "string") return entry.value;
  const tiny = entry.decimals > 6; // a closure error: its size matters, not its digits
  const digits = entry.decimals;
  const value = tiny
    ? entry.value === 0
      ? "0"
      : entry.value.toExponential(1).replaceAll("-", "\u2212")
    : number(entry.value, digits);
  const spread = sd === undefined ? "" : ` \u00b1 ${number(sd, digits)}`;
  const range = p05 === undefined || p95 === undefined ? "" : ` (${number(p05, digits)} to ${number(p95, digits)})`;
  const unit = unitWords(entry.unit);
  return value + spread + range + (unit === "" ? "" : unit === "\u00b0" ? unit : `\u2009${unit}`);
}

function table(head, rows) {
  return h(
    "div",
    { class: "scroll" },
    h("table", { class: "data" }, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows)),
  );
}

/** Whole sentences take the place of the definition too, where they can wrap. */
function scoreRow(item, reference) {
  const { key, label, value } = item.entry,
    sentence = typeof value === "string" && value.length > 40;
  return h(
    "tr",
    {},
    h("td", {}, label),
    h("td", { class: sentence ? "plain" : "number", colspan: sentence ? 2 : null, "data-key": key }, scoreWords(item)),
    sentence ? null : h("td", { class: "plain" }, definition(key, reference)),
  );
}

export function drawScores(data) {
  const box = document.getElementById("score"),
    { score } = data;
  const rows = [],
    sections = scoreSections(score),
    hasSpread = sections.some((s) => s.items.some((item) => item.sd !== undefined));
  const ordered = [...sections].sort((a, b) => b.title.startsWith("Agreement") - a.title.startsWith("Agreement"));
  for (const section of ordered) {
    rows.push(h("tr", { class: "group" }, h("td", { colspan: 3 }, section.title)));
    for (const item of section.items) rows.push(scoreRow(item, data.run.survey));
  }
  if (score.not_scored.length) rows.push(h("tr", { class: "group" }, h("td", { colspan: 3 }, "Not scored")));
  for (const { key, why } of score.not_scored) {
    rows.push(
      h(
        "tr",
        {},
        h("td", {}, h("code", {}, key)),
        h("td", { class: "number" }, "not scored"),
        h("td", { class: "plain" }, why),
      ),
    );
  }
  box.append(
    table([h("th", {}, "Quantity"), h("th", { class: "number" }, "Value"), h("th", {}, "In plain words")], rows),
  );
  if (hasSpread) {
    box.append(
      h(
        "p",
        { class: "note" },
        "\u00b1: standard deviation of the score when the survey's own error is drawn again and again; " +
          "in brackets the 5th and 95th of 100 such scores.",
      ),
    );
  }
  box.append(
    h("h3", {}, "Definitions"),
    h(
      "ul",
      { class: "plain-list note" },
      score.notes.map((note) => h("li", {}, note)),
    ),
  );
}

const severities = { advice: "Advice", warning: "Warning", refusal: "Refused, and accepted by the recipe" };

/** What the stages found doubtful. */
export function drawFindings(data) {
  const { findings } = data.score,
    row = (f) =>
      h(
        "tr",
        {},
        h("td", {}, severities[f.severity]),
        h(
          "td",
          { class: "plain", "data-finding": f.name },
          f.message,
          h("div", { class: "note" }, h("code", {}, f.name)),
        ),
        h("td", {}, h("code", {}, `[${f.stage}]`)),
      );
  document.getElementById("findings-section").hidden = findings.length === 0;
  document
    .getElementById("findings")
    .append(table([h("th", {}, "Severity"), h("th", {}, "Finding"), h("th", {}, "Table")], findings.map(row)));
}

/** From which thickness on an area counts, for each body. */
function areaWords(bodies) {
  const parts = bodies.filter((b) => b.volume > 0).map((b) => `${b.name.toLowerCase()} ${number(b.limit, 2)} m`);
  return `Areas count cells thicker than: ${parts.join(", ")}. The slope is that of the bed.`;
}

/** The volume both ways, from the maps; the names of the columns say which is which. */
export function drawVolumes(data) {
  const box = document.getElementById("volumes"),
    bodies = data.volumes;
  const cell = (words) => h("td", { class: "number" }, words);
  const rows = bodies
    .filter((b) => b.volume > 0)
    .map((b) =>
      h(
        "tr",
        {},
        h("td", {}, b.name),
        cell(volume(b.volume)),
        cell(volume(b.volume_if_normal)),
        cell(`${number(100 * (b.volume_if_normal / b.volume - 1), 1)}\u2009%`),
        cell(area(b.area_projected)),
        cell(area(b.area_true)),
        cell(quantity(b.thickest, "m", 1)),
        cell(quantity(b.thickest_normal, "m", 1)),
      ),
    );
  const heads = [
    "Volume",
    "Volume if read as slope-normal",
    "Mistake that would be",
    "Area, projected",
    "Area, true",
    "Thickest, vertical",
    "Thickest, slope-normal",
  ];
  box.append(table([h("th", {}, "Body"), ...heads.map((words) => h("th", { class: "number" }, words))], rows));
  box.append(
    h(
      "p",
      { class: "note prose" },
      "Every thickness in this report is vertical, as the difference of two elevation models is. Models that " +
        "average over " +
        "depth often give it normal to the slope; there it is thinner by the cosine of the slope for the same " +
        "body. The third column is the volume that would " +
        `result if these vertical numbers were handed to such a model as they are. ${areaWords(bodies)}`,
    ),
  );
}

/** "path  sha256 abc" taken apart. */
function fileRow(stage, kind, text) {
  const [, path, rest] = /^(.*?)  (.*)$/.exec(text) ?? [null, text, ""];
  return h(
    "tr",
    {},
    h("td", {}, stage),
    h("td", {}, kind),
    h("td", { class: "path" }, path),
    h("td", { class: "hash" }, rest.replace(/^sha256 /, "")),
  );
}

export function drawInputs(data) {
  const box = document.getElementById("inputs"),
    rows = [];
  for (const { stage, missing, facts } of data.stages) {
    if (missing) {
      rows.push(
        h(
          "tr",
          {},
          h("td", {}, stage),
          h(
            "td",
            { class: "missing", colspan: 3 },
            `${stage}.used.toml was not found beside the run: its inputs are not known here.`,
          ),
        ),
      );
    }
    for (const [name, value] of facts)
      if (name === "recipe" || name === "input") rows.push(fileRow(stage, name, value));
  }
  box.append(
    table(
      ["Stage", "Kind", "File", "SHA-256"].map((words) => h("th", {}, words)),
      rows,
    ),
  );
}

export function drawParameters(data) {
  const box = document.getElementById("parameters");
  const note = h("p", { class: "note" }, "Highlighted: changed from the default, which stands in the last column.");
  const toggle = h(
    "label",
    { class: "screen-only" },
    h("input", { type: "checkbox", id: "all-parameters" }),
    " show the others too",
  );
  box.append(note, toggle);
  for (const stage of data.stages) box.append(...parametersOf(stage));
  const show = (all) =>
    box.querySelectorAll(".usual").forEach((part) => {
      part.hidden = !all;
    });
  toggle.firstChild.addEventListener("change", (event) => show(event.target.checked));
  show(false);
  window.addEventListener("beforeprint", () => show(true));
  window.addEventListener("afterprint", () => show(toggle.firstChild.checked));
}

/** A key with its tables, without that of its stage; [ensemble] is a table of its own. */
function keyName({ table, key }, stage) {
  const name = `${table}.${key}`;
  return name.startsWith(`${stage}.`) ? name.slice(stage.length + 1) : name;
}

function parametersOf(stage) {
  const title = h("h3", {}, `talus-${stage.stage}`);
  if (stage.missing)
    return [title, h("p", { class: "missing" }, `${stage.stage}.used.toml was not found beside the run.`)];
  const rows = [];
  const changed = stage.keys.filter((key) => key.default !== null).length;
  for (const key of stage.keys) {
    const isChanged = key.default !== null;
    rows.push(
      h(
        "tr",
        { class: isChanged ? "changed" : "usual" },
        h("td", {}, h("code", {}, keyName(key, stage.stage))),
        h("td", {}, h("code", { class: "path" }, key.value)),
        h("td", {}, isChanged ? h("code", {}, key.default) : null),
      ),
    );
  }
  const words = `${changed || "None"} of ${stage.keys.length} changed from ${changed > 1 ? "their" : "its"} default.`;
  return [
    title,
    h("p", { class: "note" }, words),
    h(
      "div",
      { class: changed ? "stage-parameters" : "stage-parameters usual" },
      table([h("th", {}, "Parameter"), h("th", {}, "Value used"), h("th", {}, "Default")], rows),
    ),
  ];
}

const notFacts = [
  "What was used, defaults filled in. This file is itself a recipe",
  "recipe",
  "input",
  "program",
  "command",
  "hardware",
];

export function drawVersions(data) {
  const box = document.getElementById("versions"),
    rows = [],
    { run } = data;
  for (const { stage, missing, facts } of data.stages) {
    const fact = (name) => facts.find(([key]) => key === name)?.[1] ?? "not known";
    const rest = facts.filter(([name]) => !notFacts.includes(name));
    rows.push(
      h(
        "tr",
        {},
        h("td", {}, stage),
        h("td", {}, missing ? "not known" : fact("program")),
        h("td", {}, missing ? "" : fact("hardware")),
        h("td", { class: "path" }, missing ? "" : fact("command")),
      ),
    );
    if (rest.length)
      rows.push(
        h(
          "tr",
          {},
          h("td", {}),
          h("td", { class: "plain", colspan: 3 }, rest.map(([name, value]) => `${name}: ${value}`).join(" \u00b7 ")),
        ),
      );
  }
  box.append(
    table(
      ["Stage", "Program", "Hardware", "Command"].map((words) => h("th", {}, words)),
      rows,
    ),
  );
  const year = run.made.slice(0, 4);
  box.append(
    h("h3", {}, "How to cite"),
    h(
      "p",
      { class: "prose" },
      `Talus ${run.run_version}: a material point method for landslides from elevation models to scored maps. ` +
        `Scene \u201c${run.title}\u201d, ` +
        `report of ${run.made}${run.institution ? `, ${run.institution}` : ""}, ${year}. Name the checksums above ` +
        `with it: they say on which data it stands.`,
    ),
  );
}
