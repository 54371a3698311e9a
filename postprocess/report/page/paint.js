// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grids to pixels. Colours are those of the legend, shaded by the ground, so that the relief shows through.

const widest = 1500; // pixels along the longer side; edges of classes are smooth at this size

/** How values between cell centres are found: "smooth" counts no data as 0; "masked" and "positive" keep the outline of
 * the cells that have data, or more than 0, and are smooth inside; "cells" takes the cell's own. */
export function blending(layer) {
  if (layer.codes) return "cells";
  if (layer.id === "difference" || layer.id === "arrival") return "masked";
  return layer.unit === "m" ? "smooth" : "positive";
}

/** True where a value does not count. */
function absent(value, mode) {
  return Number.isNaN(value) || (mode === "positive" && value === 0);
}

/** Bilinear value at grid coordinates u, v (cells, centres at whole numbers). */
function blend(field, u, v, mode) {
  const { columns, rows } = field.grid,
    values = field.values;
  const clampedU = Math.min(Math.max(u, 0), columns - 1),
    clampedV = Math.min(Math.max(v, 0), rows - 1);
  const own = values[Math.round(clampedV) * columns + Math.round(clampedU)];
  if (mode === "cells") return own;
  if (mode !== "smooth" && absent(own, mode)) return NaN;
  const column = Math.min(Math.floor(clampedU), Math.max(columns - 2, 0)),
    row = Math.min(Math.floor(clampedV), Math.max(rows - 2, 0));
  const fu = clampedU - column,
    fv = clampedV - row,
    start = row * columns + column;
  let sum = 0,
    weights = 0;
  for (let corner = 0; corner < 4; ++corner) {
    const dx = corner & 1,
      dy = corner >> 1;
    const weight = (dx ? fu : 1 - fu) * (dy ? fv : 1 - fv);
    if (weight === 0) continue;
    const value = values[start + dx + dy * columns];
    if (mode !== "smooth" && absent(value, mode)) continue;
    sum += weight * (Number.isNaN(value) ? 0 : value);
    weights += weight;
  }
  return mode === "smooth" ? sum : sum / weights;
}

/** Pixels per cell that make a picture of about `widest`. */
function pixelsPerCell(grid, most) {
  return Math.min(Math.max(Math.round(most / Math.max(grid.columns, grid.rows)), 1), 16);
}

function canvasFor(grid, scale) {
  const canvas = document.createElement("canvas");
  canvas.width = grid.columns * scale;
  canvas.height = grid.rows * scale;
  return canvas;
}

/** Calls visit(u, v, byte offset) for every pixel, north first. */
function forPixels(canvas, scale, rows, visit) {
  for (let py = 0, at = 0; py < canvas.height; ++py) {
    const v = rows - (py + 0.5) / scale - 0.5;
    for (let px = 0; px < canvas.width; ++px, at += 4) visit((px + 0.5) / scale - 0.5, v, at);
  }
}

function rgb(hex) {
  return [1, 3, 5].map((i) => parseInt(hex.slice(i, i + 2), 16));
}

/** Hillshade in greys that leave room for colours on top. */
export function paintGround(shade) {
  const scale = pixelsPerCell(shade.grid, widest),
    canvas = canvasFor(shade.grid, scale);
  const context = canvas.getContext("2d"),
    image = context.createImageData(canvas.width, canvas.height);
  forPixels(canvas, scale, shade.grid.rows, (u, v, at) => {
    const bright = blend(shade, u, v, "smooth");
    const grey = 255 * (0.64 + 0.34 * bright);
    const known = !Number.isNaN(
      shade.values[Math.round(Math.max(v, 0)) * shade.grid.columns + Math.round(Math.max(u, 0))],
    );
    image.data.set(known ? [0.985 * grey, 0.99 * grey, grey, 255] : [237, 240, 242, 255], at);
  });
  context.putImageData(image, 0, 0);
  return canvas;
}

/** Draws classed grids, shaded by the ground; keeps the shading of a grid it has met. */
export class Painter {
  constructor(shade) {
    this.shade = shade;
    this.shading = new Map();
  }

  /** Brightness 0.87 to 1.05 at every pixel of a picture of `grid`. */
  shadingOf(grid, scale, canvas) {
    const key = [grid.columns, grid.rows, grid.west, grid.south, grid.cell, scale].join();
    if (!this.shading.has(key)) this.shading.set(key, this.computeShading(grid, scale, canvas));
    return this.shading.get(key);
  }

  computeShading(grid, scale, canvas) {
    const ground = this.shade.grid,
      factors = new Float32Array(canvas.width * canvas.height);
    forPixels(canvas, scale, grid.rows, (u, v, at) => {
      const x = grid.west + (u + 0.5) * grid.cell,
        y = grid.south + (v + 0.5) * grid.cell;
      const bright = blend(
        this.shade,
        (x - ground.west) / ground.cell - 0.5,
        (y - ground.south) / ground.cell - 0.5,
        "smooth",
      );
      factors[at / 4] = 0.87 + 0.18 * bright;
    });
    return factors;
  }

  /** Paint `field` into `canvas` (made where none is given). What lies in no class stays clear. */
  paint(field, classes, mode, { canvas = null, most = widest } = {}) {
    const scale = pixelsPerCell(field.grid, most);
    const target = canvas ?? canvasFor(field.grid, scale);
    if (target.width !== field.grid.columns * scale || target.height !== field.grid.rows * scale) {
      target.width = field.grid.columns * scale;
      target.height = field.grid.rows * scale;
    }
    const shading = this.shadingOf(field.grid, scale, target);
    const from = classes.map((c) => c.from ?? -Infinity),
      colours = classes.map((c) => rgb(c.colour));
    const end = classes.length ? (classes[classes.length - 1].to ?? Infinity) : -Infinity;
    const context = target.getContext("2d"),
      image = context.createImageData(target.width, target.height);
    forPixels(target, scale, field.grid.rows, (u, v, at) => {
      const value = blend(field, u, v, mode);
      if (!(value >= from[0]) || value >= end) return;
      let k = from.length - 1;
      while (value < from[k]) --k;
      const factor = shading[at / 4],
        colour = colours[k];
      for (let i = 0; i < 3; ++i) image.data[at + i] = colour[i] * factor;
      image.data[at + 3] = 255;
    });
    context.putImageData(image, 0, 0);
    return target;
  }
}
