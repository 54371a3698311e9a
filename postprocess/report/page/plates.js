// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Maps for paper: every layer as a still plate with frame, coordinates, scale bar, north arrow and legend.
import { blending } from "./paint.js";
import { h, number, unitWords } from "./format.js";
import { ticks } from "./map.js";
import { drawPlaces } from "./places.js";

const ink = "#1a1c20",
  face = '"Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", "DejaVu Sans", sans-serif';

/** A round length of at most `limit` metres. */
function roundBelow(limit) {
  const power = 10 ** Math.floor(Math.log10(limit));
  return [5, 2, 1].map((m) => m * power).find((length) => length <= limit);
}

/** One plate: the map window on a canvas, all lengths in pixels of a picture `width` wide. */
class Plate {
  constructor(window, width, tallest) {
    this.type = width > 1500 ? 24 : 27; // smaller plates need larger type
    this.stroke = width > 1500 ? 1.8 : 1.35;
    const sideways = width - 2 * 62,
      scale = Math.min(sideways / (window.east - window.west), tallest / (window.north - window.south));
    const size = { width: (window.east - window.west) * scale, height: (window.north - window.south) * scale };
    this.window = window;
    this.scale = scale;
    this.box = { x: (width - size.width) / 2, y: 12, ...size };
    this.canvas = document.createElement("canvas");
    this.canvas.width = width;
    this.canvas.height = Math.ceil(size.height + 12 + 112);
    this.context = this.canvas.getContext("2d");
  }

  pixel(x, y) {
    return [this.box.x + (x - this.window.west) * this.scale, this.box.y + (this.window.north - y) * this.scale];
  }

  /** A painted grid in its place. */
  image(picture, field) {
    const [left, top] = this.pixel(field.grid.west, field.north),
      [right, bottom] = this.pixel(field.east, field.grid.south);
    this.clipped(() => this.context.drawImage(picture, left, top, right - left, bottom - top));
  }

  clipped(draw) {
    const { x, y, width, height } = this.box;
    this.context.save();
    this.context.beginPath();
    this.context.rect(x, y, width, height);
    this.context.clip();
    draw();
    this.context.restore();
  }

  lines({ lines, style }) {
    this.clipped(() => {
      for (const [colour, width, opacity, dashes] of [
        ["#fff", style.casing, 0.8, []],
        [style.colour, style.width, style.opacity ?? 1, style.dashes ?? []],
      ]) {
        if (!width) continue;
        Object.assign(this.context, {
          strokeStyle: colour,
          lineWidth: this.stroke * width,
          globalAlpha: opacity,
          lineJoin: "round",
        });
        this.context.setLineDash(dashes.map((d) => this.stroke * d));
        this.context.beginPath();
        for (const line of lines)
          line.forEach(([x, y], i) => this.context[i ? "lineTo" : "moveTo"](...this.pixel(x, y)));
        this.context.stroke();
      }
    });
  }

  text(words, x, y, size, align = "center", bold = false) {
    Object.assign(this.context, {
      fillStyle: ink,
      font: `${bold ? "bold " : ""}${size}px ${face}`,
      textAlign: align,
      textBaseline: "alphabetic",
    });
    this.context.fillText(words, x, y);
  }

  /** Frame and coordinates. */
  frame() {
    const { x, y, width, height } = this.box,
      { window } = this,
      context = this.context;
    Object.assign(context, { strokeStyle: ink, lineWidth: 3 });
    context.setLineDash([]);
    context.strokeRect(x, y, width, height);
    for (const east of ticks(window.west, window.east, width / 210)) {
      const [px] = this.pixel(east, window.south);
      context.fillStyle = ink;
      context.fillRect(px - 1, y + height, 2, 10);
      this.text(number(east), px, y + height + 36, this.type);
    }
    for (const north of ticks(window.south, window.north, height / 210)) {
      const [, py] = this.pixel(window.west, north);
      context.fillRect(x - 10, py - 1, 10, 2);
      context.save();
      context.translate(x - 18, py);
      context.rotate(-Math.PI / 2);
      this.text(number(north), 0, 0, this.type);
      context.restore();
    }
  }

  /** Below the frame. */
  scaleBar() {
    const length = roundBelow(0.3 * (this.window.east - this.window.west)),
      width = length * this.scale;
    const x = this.box.x + 4,
      y = this.box.y + this.box.height + 56,
      kilometres = length >= 2000;
    for (let i = 0; i < 4; ++i) {
      this.context.fillStyle = i % 2 ? "#fff" : ink;
      this.context.fillRect(x + (i * width) / 4, y, width / 4, 12);
    }
    Object.assign(this.context, { strokeStyle: ink, lineWidth: 1.5 });
    this.context.strokeRect(x, y, width, 12);
    this.text("0", x + 4, y + 38, this.type);
    this.text(`${kilometres ? length / 1000 : length} ${kilometres ? "km" : "m"}`, x + width, y + 38, this.type);
  }

  northArrow() {
    const x = this.box.x + this.box.width - 34,
      y = this.box.y + 14;
    const context = this.context;
    for (const [side, colour] of [
      [-1, ink],
      [1, "#b9bcc1"],
    ]) {
      Object.assign(context, { fillStyle: colour, strokeStyle: ink, lineWidth: 1.5 });
      context.beginPath();
      context.moveTo(x, y);
      context.lineTo(x + side * 15, y + 50);
      context.lineTo(x, y + 40);
      context.closePath();
      context.fill();
      context.stroke();
    }
    this.text("N", x, y + 76, 24, "center", true);
  }
}

/** Classes side by side, much to the right; wraps where the paper ends. */
function legendRow(classes) {
  return h(
    "span",
    { style: "display:flex;flex-wrap:wrap;gap:0 9px;align-items:center" },
    classes.map((c) =>
      h(
        "span",
        { style: "white-space:nowrap;display:inline-flex;align-items:center;gap:3px" },
        h("i", { style: `width:16px;height:10px;border:0.5px solid #40434a;background:${c.colour}` }),
        c.label,
      ),
    ),
  );
}

function figure(plate, title, classes, wide) {
  return h(
    "figure",
    { class: wide ? "plate wide" : "plate" },
    plate.canvas,
    h("figcaption", {}, h("b", {}, title), " ", legendRow(classes)),
  );
}

export class Plates {
  constructor(data, fields, map, { lines, places }) {
    Object.assign(this, { data, fields, map, lines, places });
    this.box = document.getElementById("plates");
  }

  plate(field, classes, mode, { width = 1000, tallest = 640, lines = this.lines } = {}) {
    const plate = new Plate(this.data.map.window, width, tallest),
      { map } = this;
    plate.image(map.ground, this.fields.ground.shade);
    plate.image(map.painter.paint(field, classes, mode, { most: 1100 }), field);
    for (const line of lines) plate.lines(line);
    drawPlaces(plate, this.places);
    plate.frame();
    plate.scaleBar();
    plate.northArrow();
    return plate;
  }

  /** The first layer large, the others two a row, and some instants of the flow. */
  draw() {
    this.fields.layers.forEach((layer, i) => {
      const unit = layer.unit ? ` [${unitWords(layer.unit)}]` : "";
      const plate = this.plate(
        layer.field,
        layer.classes,
        blending(layer),
        i === 0 ? { width: 1800, tallest: 1150 } : {},
      );
      this.box.append(figure(plate, layer.title + unit, layer.classes, i === 0));
      if (i === 0) this.box.lastChild.append(this.lineLegend());
    });
    for (const i of this.instants()) {
      const { time, fields, classes } = this.fields.frames;
      const quiet = this.lines.filter((line) => line.id !== "thalweg" && !line.id.startsWith("survey"));
      const plate = this.plate(fields[i], classes, "smooth", { lines: quiet });
      this.box.append(figure(plate, `Flow, thickness [m] at t = ${number(time[i], 1)}\u2009s`, classes));
    }
  }

  /** Some instants spread over the time, as many as fill the last page of six plates. */
  instants() {
    const count = this.fields.frames.time.length,
      room = 6 - ((this.fields.layers.length - 1) % 6);
    const wanted = Math.min(room < 3 ? room + 6 : room, count);
    if (count < 2) return [];
    const chosen = Array.from({ length: wanted }, (_, k) => Math.round((k * (count - 1)) / (wanted - 1)));
    return [...new Set(chosen)];
  }

  lineLegend() {
    return h(
      "figcaption",
      { style: "display:flex;flex-wrap:wrap;gap:0 12px" },
      this.lines.map((line) =>
        h(
          "span",
          { style: "white-space:nowrap" },
          h("i", {
            style:
              `display:inline-block;width:26px;vertical-align:middle;margin-right:4px;` +
              `border-top:${line.style.width}px ` +
              `${line.style.dashes ? "dashed" : "solid"} ${line.style.colour}`,
          }),
          line.title,
        ),
      ),
    );
  }
}
