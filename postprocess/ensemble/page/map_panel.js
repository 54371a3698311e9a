// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map: which quantity and which of its maps is shown, at which threshold, and what it says under the cursor.
import { Field, unpack } from "../../report/page/decode.js";
import { h, number } from "../../report/page/format.js";
import { swatches } from "../../report/page/panel.js";

/** Maps that follow one another in one packed block. */
async function readStack(stack) {
  if (!stack) return [];
  const values = await unpack(stack.data),
    count = stack.grid.columns * stack.grid.rows;
  return stack.maps.map((map, i) => ({
    ...map,
    field: new Field(stack.grid, values.subarray(i * count, (i + 1) * count)),
  }));
}

export async function readMaps(map) {
  const ground = {
    elevation: new Field(map.ground.grid, await unpack(map.ground.elevation)),
    shade: new Field(map.ground.grid, await unpack(map.ground.shade)),
  };
  const quantities = [];
  for (const quantity of map.quantities)
    quantities.push({
      ...quantity,
      shares: await readStack(quantity.shares),
      statistics: await readStack(quantity.statistics),
    });
  return { ground, quantities, hazard: (await readStack(map.hazard))[0] ?? null };
}

/** Half the width of Wilson's interval at one sigma, and the members that would halve it (sampling_error.hpp). */
export function standardError(share, draws) {
  return Math.sqrt(share * (1 - share) * draws + 0.25) / (draws + 1);
}
export function membersToHalve(share, draws) {
  const pq = share * (1 - share),
    e = standardError(share, draws);
  return (pq + Math.sqrt(pq * pq + e * e * (0.25 - pq))) / (0.5 * e * e) - 1;
}

const errorColours = ["#fff7d6", "#fee391", "#fec44f", "#fe9929", "#d95f0e", "#993404"];

function errorClasses(draws) {
  const most = standardError(0.5, draws),
    step = most / errorColours.length;
  return errorColours.map((colour, i) => ({
    from: i ? i * step : -1,
    to: i + 1 < errorColours.length ? (i + 1) * step : null,
    colour,
    label: `${number(100 * i * step, 1)} \u2013 ${number(100 * (i + 1) * step, 1)} points`,
  }));
}

export class MapPanel {
  constructor(data, fields, map) {
    Object.assign(this, { data, fields, map });
    this.draws = data.run.draws;
    this.threshold = new Map();
    this.quantity = fields.quantities[0];
    this.layer = "share";
    this.makeQuantities();
    const slider = document.getElementById("threshold");
    slider.addEventListener("input", () => {
      this.threshold.set(this.quantity.id, Number(slider.value));
      this.draw();
    });
    map.onCursor((place) => this.showValues(place));
    this.chooseQuantity(this.quantity.id);
  }

  radio(box, name, value, words, choose) {
    const input = h("input", { type: "radio", name, value, id: `${name}-${value}` });
    input.addEventListener("change", () => choose(value));
    box.append(h("label", {}, input, words));
  }

  makeQuantities() {
    const box = document.getElementById("quantities");
    for (const { id, title } of this.fields.quantities)
      this.radio(box, "quantity", id, title, (value) => this.chooseQuantity(value));
  }

  layers() {
    const list = this.quantity.shares.length
      ? [
          ["share", this.data.run.share.is_probability ? "Probability at the threshold" : "Share of the members"],
          ["error", "Its standard error"],
          ["needed", "Members that would halve it"],
        ]
      : [];
    for (const map of this.quantity.statistics) list.push([map.id, map.title]);
    if (this.fields.hazard) list.push(["hazard", "Hazard class"]);
    list.push(["none", "Ground alone"]);
    return list;
  }

  chooseQuantity(id) {
    this.quantity = this.fields.quantities.find((quantity) => quantity.id === id);
    document.getElementById(`quantity-${id}`).checked = true;
    const box = document.getElementById("layers");
    box.replaceChildren();
    const layers = this.layers();
    for (const [value, words] of layers) this.radio(box, "layer", value, words, (chosen) => this.chooseLayer(chosen));
    const stays = layers.some(([value]) => value === this.layer);
    this.chooseLayer(stays ? this.layer : layers[0][0]);
  }

  chooseLayer(id) {
    this.layer = id;
    document.getElementById(`layer-${id}`).checked = true;
    this.draw();
  }

  /** The map of shares at the threshold that the slider shows. */
  share() {
    const { shares, id } = this.quantity;
    return shares[Math.min(this.threshold.get(id) ?? Math.min(1, shares.length - 1), shares.length - 1)];
  }

  derived(of, classes, title) {
    const share = this.share();
    const values = share.field.values.map((value) => (Number.isNaN(value) ? NaN : of(value)));
    return { title: `${title}: ${share.title}`, classes, field: new Field(share.field.grid, values), unit: "" };
  }

  shown() {
    if (this.layer === "none") return null;
    if (this.layer === "share") return this.share();
    if (this.layer === "error")
      return this.derived((p) => standardError(p, this.draws), errorClasses(this.draws), "Standard error");
    if (this.layer === "needed") {
      const whole = this.data.run.counted / this.draws;
      const limits = [2, 2.5, 3, 3.5, 3.9].map((factor) => factor * this.data.run.counted);
      const classes = limits.map((from, i) => ({
        from: i ? from : 0,
        to: limits[i + 1] ?? null,
        colour: errorColours[i + 1],
        label: `${number(from)} or more`,
      }));
      return this.derived((p) => membersToHalve(p, this.draws) * whole, classes, "Members that would halve the error");
    }
    if (this.layer === "hazard") return this.fields.hazard;
    return this.quantity.statistics.find((map) => map.id === this.layer);
  }

  draw() {
    const by = ["share", "error", "needed"].includes(this.layer),
      { shares, unit, early, title } = this.quantity;
    const row = document.getElementById("threshold-row"),
      slider = document.getElementById("threshold");
    row.hidden = !by;
    if (by) {
      slider.max = shares.length - 1;
      slider.value = shares.indexOf(this.share());
      const words = `${this.share().level} ${unit} or ${early ? "less" : "more"}`;
      slider.setAttribute("aria-valuetext", words);
      document.getElementById("threshold-name").textContent = title;
      document.getElementById("threshold-label").textContent = words;
    }
    const layer = this.shown();
    const mode = this.layer === "hazard" || !layer ? "cells" : "masked";
    this.map.show(layer?.field, layer?.classes ?? [], mode);
    this.drawLegend(layer);
    this.showValues(this.place ?? null);
  }

  drawLegend(layer) {
    const { run } = this.data;
    const about =
      {
        share: `${run.share.meaning} ${number(run.counted)} members are counted.`,
        error: `${run.share.error} In points of a per cent, for ${number(this.draws)} draws.`,
        needed: "Counted members that it would take for half the standard error, by the same design.",
        hazard: `The largest class of: ${run.hazard}.`,
        none: run.slides
          ? "Hillshade of the model, within the slides' domains."
          : "Hillshade of the surface before the failure.",
      }[this.layer] ??
      (run.slides
        ? `Of ${number(run.counted)} counted slides; nothing is drawn where none came.`
        : this.data.budget
          ? "Largest less smallest thickness of the deposit over the recipe and members that differ in one thing."
          : "Over all counted members; where one did not come, it counts as 0 (times: as never).");
    document
      .getElementById("legend")
      .replaceChildren(
        h("h3", {}, layer?.title ?? "Ground alone"),
        layer ? swatches(layer.classes) : "",
        h("p", { class: "note" }, about),
      );
  }

  rows(place) {
    const rows = [
      ["East, north", `${number(place.x)}, ${number(place.y)}`],
      ["Elevation before", `${number(this.fields.ground.elevation.at(place.x, place.y), 1)} m`],
    ];
    for (const share of this.quantity.shares) {
      const value = share.field.at(place.x, place.y);
      const error = number(100 * standardError(value, this.draws), 1);
      rows.push([share.title, Number.isNaN(value) ? "\u2013" : `${number(100 * value, 1)} \u00b1 ${error} %`]);
    }
    for (const map of this.quantity.statistics)
      rows.push([map.title, this.valueAt(map, place)]);
    if (this.fields.hazard) rows.push(["Hazard class", number(this.fields.hazard.field.at(place.x, place.y))]);
    return rows;
  }

  valueAt(map, place) {
    const value = map.field.at(place.x, place.y);
    if (Number.isNaN(value) && this.data.run.slides) return "\u2013";
    return `${number(value, map.unit ? 2 : 0)} ${map.unit}`;
  }

  showValues(place) {
    this.place = place;
    const box = document.getElementById("cursor");
    if (!place) {
      box.replaceChildren(h("h3", {}, "At the cursor"), h("p", { class: "note" }, "Move over the map, or tap it."));
      return;
    }
    const rows = this.rows(place).map(([name, words]) => h("tr", {}, h("td", {}, name), h("td", {}, words)));
    box.replaceChildren(h("h3", {}, "At the cursor"), h("table", {}, h("tbody", {}, rows)));
  }
}
