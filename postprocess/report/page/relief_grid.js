// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The ground and the flow on one grid, as lists of numbers for the view in 3-D. Lengths are metres from the middle of
// the map and its lowest ground; x east, y north, z up.

/** Bilinear value of a field at a place; NaN where one of the four cells has none. */
function valueAt(field, x, y) {
  const { columns, rows, west, south, cell } = field.grid;
  const u = Math.min(Math.max((x - west) / cell - 0.5, 0), columns - 1),
    v = Math.min(Math.max((y - south) / cell - 0.5, 0), rows - 1);
  const i = Math.min(Math.floor(u), Math.max(columns - 2, 0)),
    j = Math.min(Math.floor(v), Math.max(rows - 2, 0));
  const right = Math.min(i + 1, columns - 1),
    up = Math.min(j + 1, rows - 1),
    fu = u - i,
    fv = v - j;
  const at = (column, row) => field.values[row * columns + column];
  return (1 - fv) * ((1 - fu) * at(i, j) + fu * at(right, j)) + fv * ((1 - fu) * at(i, up) + fu * at(right, up));
}

/** A vertex at each cell centre of the grid of the frames, at the bed: the ground without what is released. */
export class ReliefGrid {
  constructor(fields) {
    const frames = fields.frames.fields,
      deposit = fields.layers.find((layer) => layer.id === "deposit");
    this.flows = frames.length ? frames : [deposit.field];
    this.times = frames.length ? fields.frames.time : [null];
    this.classes = frames.length ? fields.frames.classes : deposit.classes;
    this.grid = this.flows[0].grid;
    this.measureBed(fields.ground.elevation, fields.layers.find((layer) => layer.id === "release").field);
  }

  get count() {
    return this.grid.columns * this.grid.rows;
  }

  measureBed(before, release) {
    const { columns, rows, west, south, cell } = this.grid;
    this.width = columns * cell;
    this.height = rows * cell;
    this.bed = new Float32Array(this.count);
    let low = Infinity,
      high = -Infinity;
    for (let row = 0, i = 0; row < rows; ++row) {
      for (let column = 0; column < columns; ++column, ++i) {
        const x = west + (column + 0.5) * cell,
          y = south + (row + 0.5) * cell,
          thickness = valueAt(release, x, y);
        const bed = valueAt(before, x, y) - (Number.isNaN(thickness) ? 0 : thickness);
        this.bed[i] = bed;
        if (bed < low) low = bed;
        if (bed > high) high = bed;
      }
    }
    this.low = Number.isFinite(low) ? low : 0;
    this.relief = Number.isFinite(high - low) ? high - low : 0;
  }

  /** x, y, z of all vertices; z above the lowest ground, NaN as 0 (such vertices are in no triangle). */
  positions(thickness) {
    const { columns, rows, cell } = this.grid,
      list = new Float32Array(3 * this.count);
    for (let row = 0, i = 0; row < rows; ++row) {
      for (let column = 0; column < columns; ++column, ++i) {
        const z = this.bed[i] - this.low + (thickness ? thickness[i] || 0 : 0);
        list[3 * i] = (column + 0.5) * cell - 0.5 * this.width;
        list[3 * i + 1] = (row + 0.5) * cell - 0.5 * this.height;
        list[3 * i + 2] = Number.isNaN(z) ? 0 : z;
      }
    }
    return list;
  }

  /** Places on a picture of the grid, its north on top: u, v of all vertices. */
  places() {
    const { columns, rows } = this.grid,
      list = new Float32Array(2 * this.count);
    for (let i = 0; i < this.count; ++i) {
      list[2 * i] = ((i % columns) + 0.5) / columns;
      list[2 * i + 1] = (Math.floor(i / columns) + 0.5) / rows;
    }
    return list;
  }

  /** Two triangles between each four vertices that have a bed and of which `shown` says yes to one. */
  triangles(shown) {
    const { columns, rows } = this.grid,
      list = [];
    for (let row = 0; row + 1 < rows; ++row) {
      for (let column = 0; column + 1 < columns; ++column) {
        const a = row * columns + column,
          b = a + 1,
          c = b + columns,
          d = a + columns;
        if (shown && !(shown(a) || shown(b) || shown(c) || shown(d))) continue;
        if (Number.isNaN(this.bed[a] + this.bed[b] + this.bed[c] + this.bed[d])) continue;
        list.push(a, b, c, a, c, d);
      }
    }
    return new Uint32Array(list);
  }

  /** Light on a surface from the north-west, 0 to 1, at all vertices. */
  light(positions) {
    const { columns, rows, cell } = this.grid,
      list = new Float32Array(this.count);
    const z = (column, row) => positions[3 * (row * columns + column) + 2];
    for (let row = 0, i = 0; row < rows; ++row) {
      for (let column = 0; column < columns; ++column, ++i) {
        const left = Math.max(column - 1, 0),
          right = Math.min(column + 1, columns - 1),
          down = Math.max(row - 1, 0),
          up = Math.min(row + 1, rows - 1);
        const east = (z(right, row) - z(left, row)) / ((right - left || 1) * cell),
          north = (z(column, up) - z(column, down)) / ((up - down || 1) * cell);
        list[i] = Math.max(0, (0.5 * east - 0.5 * north + Math.SQRT1_2) / Math.hypot(east, north, 1));
      }
    }
    return list;
  }

  /** The surface of the flow at a frame: positions, shades (grey, three numbers a vertex) and triangles. */
  flow(frame) {
    const thickness = this.flows[frame].values,
      thinnest = this.classes[0].from ?? 0;
    const positions = this.positions(thickness),
      light = this.light(positions);
    const shades = new Float32Array(3 * this.count);
    for (let i = 0; i < shades.length; ++i) shades[i] = 0.7 + 0.4 * light[Math.floor(i / 3)];
    return { positions, shades, triangles: this.triangles((i) => thickness[i] >= thinnest) };
  }

  /** Volume between the bed and the surface of a frame as it is drawn [m3]; the test compares it with the run's. */
  volume(frame) {
    const { positions, triangles } = this.flow(frame),
      third = (this.grid.cell * this.grid.cell) / 6;
    let sum = 0;
    for (const i of triangles) sum += third * (positions[3 * i + 2] + this.low - this.bed[i]);
    return sum;
  }
}
