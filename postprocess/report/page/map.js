// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The map: Leaflet on plain metres (CRS.Simple), y = north. Leaflet's latitude is y, its longitude x.
import { blending, paintGround, Painter } from "./paint.js";
import { number } from "./format.js";
import { placesLayer } from "./places.js";

/** A canvas laid over a part of the map, below all lines, whenever it is made. */
const CanvasOverlay = L.ImageOverlay.extend({
  options: { pane: "fields" },
  _initImage() {
    const canvas = this._url; // Leaflet's name for what is shown
    L.DomUtil.addClass(canvas, "leaflet-image-layer");
    if (this._zoomAnimated) L.DomUtil.addClass(canvas, "leaflet-zoom-animated");
    this._image = canvas;
  },
});

function boundsOf(field) {
  return [
    [field.grid.south, field.grid.west],
    [field.north, field.east],
  ];
}

/** White line below, coloured one on top. */
function lineLayer({ lines, style }) {
  const latlngs = lines.map((line) => line.map(([x, y]) => [y, x]));
  const options = { interactive: false, smoothFactor: 0.6, lineJoin: "round" };
  const group = L.layerGroup();
  if (style.casing)
    group.addLayer(L.polyline(latlngs, { ...options, color: "#fff", weight: style.casing, opacity: 0.8 }));
  group.addLayer(
    L.polyline(latlngs, {
      ...options,
      color: style.colour,
      weight: style.width,
      opacity: style.opacity ?? 1,
      dashArray: (style.dashes ?? []).join(" ") || null,
    }),
  );
  return group;
}

const NorthArrow = L.Control.extend({
  onAdd() {
    const box = L.DomUtil.create("div", "north");
    box.innerHTML =
      '<svg width="26" height="36" viewBox="0 0 26 36" role="img" aria-label="North is up">' +
      '<path d="M13 1 L22 34 L13 27 Z" fill="#b9bcc1" stroke="#1a1c20"/><path d="M13 1 L4 34 L13 27 Z" ' +
      'fill="#1a1c20" stroke="#1a1c20"/></svg><br>N';
    return box;
  },
});

/** Multiples of a round step inside [low, high], about `wanted`. */
export function ticks(low, high, wanted) {
  const rough = (high - low) / wanted,
    power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((m) => m * power).find((s) => s >= rough);
  const places = [];
  for (let k = Math.ceil(low / step); k * step <= high; ++k) places.push(k * step);
  return places;
}

export class ReportMap {
  constructor(element, data, fields, lines) {
    this.fields = fields;
    this.window = data.map.window;
    this.painter = new Painter(fields.ground.shade);
    this.ground = paintGround(fields.ground.shade);
    this.canvas = document.createElement("canvas");
    this.fit(element);
    this.leaflet = this.makeLeaflet(element);
    this.leaflet.createPane("fields").style.zIndex = 350; // lines: 400
    this.leaflet.addLayer(new CanvasOverlay(this.ground, boundsOf(fields.ground.shade)));
    this.thematic = null;
    this.overlays = new Map(lines.map((line) => [line.id, lineLayer(line).addTo(this.leaflet)]));
    this.marker = L.circleMarker([0, 0], {
      radius: 6,
      color: "#fff",
      weight: 2,
      fillColor: "#8c1a73",
      fillOpacity: 1,
      interactive: false,
    });
    this.drawTicks(element);
  }

  /** The frame takes the proportions of what it shows, as far as the screen allows. */
  fit(element) {
    if (!element.clientWidth) return;
    const { west, south, east, north } = this.window,
      most = Math.max(360, Math.min(0.86 * window.innerHeight, 860));
    const height = (element.clientWidth * (north - south)) / (east - west);
    element.style.height = `${Math.min(Math.max(height, 340), most)}px`;
  }

  makeLeaflet(element) {
    const { west, south, east, north } = this.window;
    const bounds = L.latLngBounds([
      [south, west],
      [north, east],
    ]);
    const map = L.map(element, {
      crs: L.CRS.Simple,
      attributionControl: false,
      zoomSnap: 0,
      zoomDelta: 0.7,
      minZoom: -12,
      maxZoom: 6,
      scrollWheelZoom: false,
      dragging: !L.Browser.mobile,
      maxBounds: bounds.pad(0.5),
    });
    map.fitBounds(bounds, { animate: false });
    map.setMinZoom(map.getZoom() - 1);
    map.on("focus click", () => map.scrollWheelZoom.enable()); // pages scroll past a map that was not asked for
    map.on("blur mouseout", () => map.scrollWheelZoom.disable());
    L.control.scale({ imperial: false, maxWidth: 160, position: "bottomleft" }).addTo(map);
    new NorthArrow({ position: "topright" }).addTo(map);
    this.followSize(element, map, bounds);
    return map;
  }

  /** A frame that changes its size shows the whole again, until somebody has moved or zoomed it. */
  followSize(element, map, bounds) {
    let touched = false;
    map.on("dragstart boxzoomstart dblclick", () => {
      touched = true;
    });
    element.addEventListener(
      "wheel",
      () => {
        touched = true;
      },
      { passive: true },
    );
    element.querySelector(".leaflet-control-zoom").addEventListener("click", () => {
      touched = true;
    });
    new ResizeObserver(() => {
      if (!element.clientWidth) return; // hidden while printing
      map.invalidateSize({ animate: false });
      if (touched) return;
      map.setMinZoom(-12);
      map.fitBounds(bounds, { animate: false });
      map.setMinZoom(map.getZoom() - 1);
    }).observe(element);
    window.addEventListener("resize", () => this.fit(element));
  }

  /** Coordinates along the lower and left edge. */
  drawTicks(element) {
    let labels = [];
    const draw = () => {
      labels.forEach((label) => label.remove());
      labels = [];
      const seen = this.leaflet.getBounds(),
        size = this.leaflet.getSize();
      const add = (kind, value, side, place) => {
        const label = L.DomUtil.create("span", `tick ${kind}`, element);
        label.textContent = number(value);
        label.style[side] = `${place}px`;
        labels.push(label);
      };
      for (const x of ticks(seen.getWest(), seen.getEast(), size.x / 130)) {
        const place = this.leaflet.latLngToContainerPoint([seen.getSouth(), x]).x;
        if (place > 90 && place < size.x - 40) add("x", x, "left", place);
      }
      for (const y of ticks(seen.getSouth(), seen.getNorth(), size.y / 110)) {
        const place = this.leaflet.latLngToContainerPoint([y, seen.getWest()]).y;
        if (place > 90 && place < size.y - 75) add("y", y, "top", place);
      }
    };
    this.leaflet.on("moveend resize zoomend", draw);
    draw();
  }

  /** Show a grid in its classes; null shows the ground alone. */
  show(field, classes, mode) {
    if (this.thematic) this.leaflet.removeLayer(this.thematic);
    this.thematic = null;
    if (!field) return;
    this.painter.paint(field, classes, mode, { canvas: this.canvas });
    this.thematic = new CanvasOverlay(this.canvas, boundsOf(field)).addTo(this.leaflet);
  }

  showLayer(layer) {
    this.show(layer?.field, layer?.classes, layer && blending(layer));
  }

  /** A frame of the flow; smaller than a still picture, to keep up. */
  showFrame(i) {
    const field = this.fields.frames.fields[i];
    if (this.shownFrames !== this.thematic || !this.thematic) {
      this.show(field, this.fields.frames.classes, "smooth");
      this.shownFrames = this.thematic;
    }
    this.painter.paint(field, this.fields.frames.classes, "smooth", { canvas: this.canvas, most: 900 });
  }

  addPlaces(places) {
    this.overlays.set("places", placesLayer(places).addTo(this.leaflet));
  }

  toggle(id, on) {
    const overlay = this.overlays.get(id);
    if (on) overlay.addTo(this.leaflet);
    else this.leaflet.removeLayer(overlay);
  }

  /** Point at a place, or nowhere. */
  point(place) {
    if (!place) this.marker.remove();
    else this.marker.setLatLng([place[1], place[0]]).addTo(this.leaflet);
  }

  /** Call with map coordinates under the cursor. A tap counts as well. */
  onCursor(tell) {
    this.leaflet.on("mousemove click", (event) => tell({ x: event.latlng.lng, y: event.latlng.lat }));
  }
}
