// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Gauges and obstacles: on the map, on the printed plates, and in a list.
import { area, h, number, unitOfPowers } from "./format.js";

const ink = "#1a1c20",
  fill = "#f2c14e";

/** Places with their rings in map coordinates: {kind, name, rings, measured}. */
export function placesOf(data) {
  const { west, south } = data.map.window;
  return data.places.map((place) => ({
    ...place,
    rings: place.rings.map((flat) => {
      const ring = [];
      for (let i = 0; i < flat.length; i += 2) ring.push([flat[i] + west, flat[i + 1] + south]);
      return ring;
    }),
  }));
}

function isPoint(place) {
  return place.rings.length === 1 && place.rings[0].length === 1;
}

/** Sections and inflows are lines, which are neither closed nor filled. */
function isLine(place) {
  return place.kind === "section" || place.kind === "inflow";
}

/** A layer of the map that holds all of them, each with its name. */
export function placesLayer(places) {
  const group = L.layerGroup();
  for (const place of places) {
    const rings = place.rings.map((ring) => ring.map(([x, y]) => [y, x]));
    const options = { color: ink, weight: 1.6, fillColor: fill, fillOpacity: 0.9 };
    const shape = isPoint(place)
      ? L.circleMarker(rings[0][0], { ...options, radius: 5 })
      : isLine(place)
        ? L.polyline(rings, { color: ink, weight: 3 })
        : L.polygon(rings, options);
    const words = document.createElement("span");
    words.textContent = place.name; // names are not markup
    const permanent = places.length <= 12;
    shape.bindTooltip(words, { permanent, direction: "right", offset: [6, 0], className: "place" });
    group.addLayer(shape);
  }
  return group;
}

/** The same on a plate. */
export function drawPlaces(plate, places) {
  plate.clipped(() => {
    const context = plate.context;
    for (const place of places) {
      Object.assign(context, { strokeStyle: ink, fillStyle: fill, lineWidth: 1.6 * plate.stroke });
      context.setLineDash([]);
      for (const ring of place.rings) {
        context.beginPath();
        if (isPoint(place)) context.arc(...plate.pixel(...ring[0]), 5 * plate.stroke, 0, 2 * Math.PI);
        else ring.forEach(([x, y], i) => context[i ? "lineTo" : "moveTo"](...plate.pixel(x, y)));
        if (isLine(place)) context.lineWidth = 3 * plate.stroke;
        else {
          context.closePath();
          context.fill();
        }
        context.stroke();
      }
      if (places.length > 12) continue;
      const [x, y] = plate.pixel(...place.rings[0][0]);
      Object.assign(context, { strokeStyle: "#fff", lineWidth: 5, lineJoin: "round", textAlign: "left",
        textBaseline: "middle", font: `bold ${plate.type * 0.85}px sans-serif` });
      context.strokeText(place.name, x + 9 * plate.stroke, y);
      context.fillStyle = ink;
      context.fillText(place.name, x + 9 * plate.stroke, y);
    }
  });
}

/** Twice the signed area of a ring. */
function twiceArea(ring) {
  return ring.reduce((sum, [x, y], i) => {
    const [nextX, nextY] = ring[(i + 1) % ring.length];
    return sum + x * nextY - nextX * y;
  }, 0);
}

function middle(place) {
  const all = place.rings.flat();
  const mean = (k) => (Math.min(...all.map((p) => p[k])) + Math.max(...all.map((p) => p[k]))) / 2;
  return [mean(0), mean(1)];
}

function sizeWords(place) {
  if (isPoint(place) || isLine(place)) return "";
  return area(place.rings.reduce((sum, ring) => sum + Math.abs(twiceArea(ring)) / 2, 0));
}

/** "thickness up to 4.2 m at 12.5 s": of every quantity the value that is farthest from zero. */
function measuredWords(place) {
  return place.measured
    .map(({ quantity, unit, value, time }) => {
      const digits = Math.abs(value) >= 100 ? 0 : Math.abs(value) >= 1 ? 1 : 2;
      const large = Math.abs(value) >= 1e5;
      const words = large ? value.toExponential(2).replace("e+", " \u00b7 10^") : number(value, digits);
      return `${quantity} ${words}\u2009${unitOfPowers(unit)} at ${number(time, 1)}\u2009s`;
    })
    .join("; ");
}

export function drawPlaceList(data) {
  const section = document.getElementById("places-section"),
    places = placesOf(data);
  section.hidden = !places.length;
  document.querySelector('a[href="#places-section"]').hidden = !places.length;
  if (!places.length) return;
  const rows = places.map((place) => {
    const [x, y] = middle(place);
    return h(
      "tr",
      {},
      h("td", {}, place.name),
      h("td", {}, place.kind),
      h("td", { class: "number" }, `${number(x, 1)}, ${number(y, 1)}`),
      h("td", { class: "number" }, sizeWords(place)),
      h("td", { class: "plain" }, measuredWords(place)),
    );
  });
  const head = [h("th", {}, "Name"), h("th", {}, "Kind"), h("th", { class: "number" }, "East, north [m]"),
    h("th", { class: "number" }, "Area"), h("th", {}, "Farthest from zero over the run")];
  const table = h("table", { class: "data" }, h("thead", {}, h("tr", {}, head)), h("tbody", {}, rows));
  const note =
    "Curves of what was measured stand under \u201cOver time\u201d. Of an obstacle the middle of its outline is given.";
  document.getElementById("places").append(h("div", { class: "scroll" }, table), h("p", { class: "note" }, note));
}
