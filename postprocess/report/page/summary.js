// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Title block and key numbers.
import { area, h, number, quantity, volume } from "./format.js";
import { scoreSections, scoreWords } from "./tables.js";

/** Score entries with their spread, by key. */
function byKey(score) {
  return new Map(
    scoreSections(score)
      .flatMap((section) => section.items)
      .map((item) => [item.entry.key, item]),
  );
}

function valueOf(items, key) {
  return items.get(key)?.entry.value;
}

/** The result in one sentence or two. */
export function headline(data) {
  const items = byKey(data.score),
    get = (key) => valueOf(items, key),
    speed = get("max_peak_speed_m_s"),
    survey = data.run.survey;
  let words = `${volume(get("volume_released_m3"))} released`;
  if (get("volume_entrained_m3") > 0) words += `, ${volume(get("volume_entrained_m3"))} taken along`;
  if (get("runout_m") !== undefined) {
    words +=
      `; the deposit, thicker than ${data.run.thresholds.deposit} m, reaches ${number(get("runout_m"))} m from the ` +
      `crown and ${number(get("drop_m"))} m below it (H/L ${number(get("h_over_l"), 2)}, angle of reach ` +
      `${number(get("fahrboeschung_deg"), 1)}\u00b0)`;
  }
  words += `. Peak speed ${number(speed, speed < 10 ? 1 : 0)} m/s; ${number(get("time_end_s"))} s simulated.`;
  const agreement = [
    ["deposit_csi", "deposit"],
    ["footprint_csi", "footprint"],
  ]
    .filter(([key]) => get(key) !== undefined)
    .map(([key, name]) => `${name} (> ${data.run.thresholds[name]} m) ${number(get(key), 2)}`);
  if (survey && agreement.length)
    words += ` Overlap with \u201c${survey.name}\u201d (CSI, 1 is perfect): ${agreement.join(", ")}.`;
  return words;
}

/** Key, title (with the thickness from which cells count), words. */
const cards = [
  ["volume_released_m3", "Released", volume],
  ["volume_entrained_m3", "Taken along", volume],
  ["runout_m", "Run-out L > {deposit}\u00a0m"],
  ["thalweg_runout_m", "Run-out, thalweg > {deposit}\u00a0m"],
  ["drop_m", "Drop H"],
  ["fahrboeschung_deg", "Angle of reach"],
  ["affected_area_m2", "Footprint > {footprint}\u00a0m", area],
  ["deposit_area_m2", "Deposit area > {deposit}\u00a0m", area],
  ["max_deposit_thickness_m", "Thickest deposit"],
  ["max_peak_speed_m_s", "Peak speed"],
  ["deposit_csi", "Deposit CSI > {deposit}\u00a0m"],
  ["footprint_csi", "Footprint CSI > {footprint}\u00a0m"],
  ["thickness_rmse_m", "Thickness RMSE"],
  ["runout_difference_m", "Run-out \u2212 {noun}"],
  ["deposit_volume_ratio", "Volume / {noun}"],
];

/** Three figures are enough at a glance; the table of scores has them all. */
function rounded(entry) {
  if (typeof entry.value !== "number" || entry.value === 0) return entry;
  const whole = Math.floor(Math.log10(Math.abs(entry.value))) + 1;
  return { ...entry, decimals: Math.min(entry.decimals, Math.max(0, 3 - Math.max(whole, 0))) };
}

/** "0.87" and below it "± 0.02". */
function card(item, title, words) {
  const { entry, sd } = item;
  const value = words ? words(entry.value) : scoreWords({ entry: rounded(entry) });
  const spread =
    sd === undefined ? null : h("span", { class: "spread" }, `\u00b1 ${quantity(sd, entry.unit, entry.decimals)}`);
  return h("div", {}, h("dt", {}, title), h("dd", { "data-key": entry.key }, value, spread));
}

export function drawSummary(data) {
  const { run } = data,
    items = byKey(data.score);
  document.getElementById("title").textContent = run.title;
  document.getElementById("headline").textContent = headline(data);
  const { belief, findings } = data.score;
  document.getElementById("belief").append(
    ...belief.map((sentence) => h("p", {}, sentence)),
    ...(findings.length ? [h("p", {}, h("a", { href: "#findings-section" }, "What the stages warn of"))] : []),
  );
  const parts = [
    `Scene ${run.scene}`,
    run.institution,
    `report of ${run.made}`,
    `Talus ${run.run_version}`,
    `${run.crs}, map cell ${run.map.cell} m`,
  ];
  document.getElementById("byline").textContent = parts.filter(Boolean).join(" \u00b7 ");
  const box = document.getElementById("key-numbers");
  const words_of = { noun: run.survey?.noun ?? "survey", ...run.thresholds };
  for (const [key, title, words] of cards) {
    const item = items.get(key);
    if (item) box.append(card(item, title.replace(/\{(\w+)\}/, (_, name) => words_of[name]), words));
  }
}
