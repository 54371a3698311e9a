// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Beside the map: which layer, its legend, what is drawn on top, values under the cursor, and the player below it.
import { h, number, unitWords } from "./format.js";
import { sample } from "./lines.js";

const flow = "flow"; // the layer that the slider shows

/** Classes from much to little, as a column of swatches; codes as they are. */
export function swatches(classes, falling = true) {
  const list = falling ? [...classes].reverse() : classes;
  return h(
    "ul",
    { class: "swatches" },
    list.map((c) => h("li", {}, h("i", { style: `background:${c.colour}` }), c.label)),
  );
}

function legendTitle(layer) {
  return layer.title + (layer.unit ? ` [${unitWords(layer.unit)}]` : "");
}

/** "Gauges", "Obstacles", or both. */
function placeWords(places) {
  const kinds = new Set(places.map((place) => place.kind));
  if (kinds.size > 1) return "Gauges, sections, obstacles";
  return { gauge: "Gauges", section: "Sections" }[[...kinds][0]] ?? "Obstacles";
}

export class Panel {
  constructor(data, fields, map, lines, places) {
    Object.assign(this, { data, fields, map });
    this.frame = 0;
    this.choices = this.layerChoices();
    this.makeLayers();
    this.makeOverlays(lines, places);
    this.makePlayer();
    map.onCursor((place) => this.showValues(place));
    this.choose(this.choices[0].id);
    this.showValues(null);
  }

  layerChoices() {
    const { frames, layers } = this.fields,
      list = [...layers];
    if (frames.time.length > 1) {
      list.splice(Math.min(5, list.length), 0, {
        id: flow,
        title: "Flow over time",
        unit: "m",
        decimals: 2,
        classes: frames.classes,
        about: "Thickness at the time the slider shows, vertical.",
      });
    }
    return [
      ...list,
      {
        id: "none",
        title: "Ground alone",
        unit: "",
        classes: [],
        about: "Hillshade of the surface before the failure.",
      },
    ];
  }

  makeLayers() {
    const box = document.getElementById("layers");
    for (const choice of this.choices) {
      const input = h("input", { type: "radio", name: "layer", value: choice.id, id: `layer-${choice.id}` });
      input.addEventListener("change", () => this.choose(choice.id));
      box.append(h("label", {}, input, choice.title));
    }
  }

  makeOverlays(lines, places) {
    const box = document.getElementById("overlays");
    if (places.length) {
      const input = h("input", { type: "checkbox", id: "overlay-places", checked: true });
      input.addEventListener("change", () => this.map.toggle("places", input.checked));
      box.append(h("label", {}, input, h("i", { class: "place-sign" }), placeWords(places)));
    }
    for (const line of [...lines].reverse()) {
      const input = h("input", { type: "checkbox", id: `overlay-${line.id}`, checked: true });
      input.addEventListener("change", () => this.map.toggle(line.id, input.checked));
      box.append(h("label", {}, input, sample(line.style), line.title));
    }
  }

  /** Show a layer and its legend. */
  choose(id) {
    this.chosen = this.choices.find((c) => c.id === id);
    document.getElementById(`layer-${id}`).checked = true;
    if (id === flow) this.map.showFrame(this.frame);
    else this.map.showLayer(this.chosen.field ? this.chosen : null);
    if (id !== flow) this.stop();
    const legend = document.getElementById("legend");
    legend.replaceChildren(
      h("h3", {}, legendTitle(this.chosen)),
      swatches(this.chosen.classes, !this.chosen.codes),
      h("p", { class: "note" }, this.chosen.about),
    );
    this.showValues(this.place ?? null);
  }

  makePlayer() {
    const player = document.getElementById("player"),
      slider = document.getElementById("time");
    const { time } = this.fields.frames;
    if (time.length < 2) {
      player.remove();
      this.stop = () => {};
      return;
    }
    slider.max = time.length - 1;
    slider.addEventListener("input", () => this.seek(Number(slider.value)));
    document.getElementById("play").addEventListener("click", () => (this.timer ? this.stop() : this.play()));
    this.labelTime();
  }

  labelTime() {
    const { time } = this.fields.frames,
      decimals = time.every((t) => Number.isInteger(t)) ? 0 : 1;
    document.getElementById("time-label").textContent =
      `t = ${number(time[this.frame], decimals)} of ${number(time[time.length - 1], decimals)}\u2009s`;
  }

  seek(frame) {
    this.frame = frame;
    document.getElementById("time").value = frame;
    this.labelTime();
    if (this.chosen.id === flow) this.map.showFrame(frame);
    else this.choose(flow);
    this.showValues(this.place ?? null);
  }

  /** All frames in about six seconds, from the start again once the end is reached. */
  play() {
    const count = this.fields.frames.time.length,
      pause = Math.min(Math.max(6000 / count, 60), 500);
    if (this.frame === count - 1) this.seek(0);
    else this.seek(this.frame);
    this.setButton(true);
    this.timer = setInterval(() => {
      if (this.frame + 1 < count) this.seek(this.frame + 1);
      if (this.frame + 1 >= count) this.stop();
    }, pause);
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.setButton(false);
  }

  setButton(playing) {
    const button = document.getElementById("play");
    button.textContent = playing ? "\u275a\u275a" : "\u25b6";
    button.setAttribute("aria-label", playing ? "Pause" : "Play the flow over time");
  }

  /** One row of the table of values. */
  valueRow(choice, place) {
    const field = choice.id === flow ? this.fields.frames.fields[this.frame] : choice.field;
    const value = field.at(place.x, place.y);
    const words = choice.codes ? (choice.classes[value - 1]?.label ?? "\u2013") : number(value, choice.decimals);
    const unit = Number.isFinite(value) && !choice.codes ? `\u2009${unitWords(choice.unit)}` : "";
    return h(
      "tr",
      { class: choice === this.chosen ? "shown" : null, "data-id": choice.id, "data-value": value },
      h("td", {}, choice.title),
      h("td", {}, words + unit),
    );
  }

  showValues(place) {
    this.place = place;
    const box = document.getElementById("cursor");
    if (!place) {
      box.replaceChildren(h("h3", {}, "At the cursor"), h("p", { class: "note" }, "Move over the map, or tap it."));
      return;
    }
    const elevation = this.fields.ground.elevation.at(place.x, place.y);
    const rows = [
      h("tr", {}, h("td", {}, "East, north"), h("td", {}, `${number(place.x)}, ${number(place.y)}`)),
      h("tr", {}, h("td", {}, "Elevation before"), h("td", {}, number(elevation, 1) + "\u2009m")),
    ];
    for (const choice of this.choices) if (choice.field || choice.id === flow) rows.push(this.valueRow(choice, place));
    box.replaceChildren(h("h3", {}, "At the cursor"), h("table", {}, h("tbody", {}, rows)));
  }
}
