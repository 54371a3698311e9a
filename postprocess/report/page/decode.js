// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grids as the page holds them (pack.hpp): base64 of a zlib stream of 16-bit numbers, high bytes first; 0 is no data.

/** Bytes of base64 text, inflated by the browser itself. */
async function inflate(text) {
  const raw = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
  const stream = new Blob([raw]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** All numbers of a packed block; NaN where there are none. */
export async function unpack(packed) {
  const bytes = await inflate(packed.bytes);
  const count = bytes.length / 2;
  const values = new Float32Array(count);
  for (let i = 0; i < count; ++i) {
    const q = bytes[i] * 256 + bytes[count + i];
    values[i] = q === 0 ? NaN : packed.offset + packed.step * (q - 1);
  }
  return values;
}

/** A grid with values; row 0 is the southernmost. Coordinates are metres of the map. */
export class Field {
  constructor(grid, values) {
    this.grid = grid;
    this.values = values;
  }

  get east() {
    return this.grid.west + this.grid.columns * this.grid.cell;
  }
  get north() {
    return this.grid.south + this.grid.rows * this.grid.cell;
  }

  /** Value of the cell that holds the place; NaN outside. */
  at(x, y) {
    const { columns, rows, west, south, cell } = this.grid;
    const column = Math.floor((x - west) / cell),
      row = Math.floor((y - south) / cell);
    if (column < 0 || row < 0 || column >= columns || row >= rows) return NaN;
    return this.values[row * columns + column];
  }
}

/** Everything the map shows, unpacked: ground, layers, frames. */
export async function readMap(map) {
  const ground = {
    elevation: new Field(map.ground.grid, await unpack(map.ground.elevation)),
    shade: new Field(map.ground.grid, await unpack(map.ground.shade)),
  };
  const layers = [];
  for (const layer of map.layers) {
    layers.push({ ...layer, data: null, field: new Field(layer.grid, await unpack(layer.data)) });
  }
  return { ground, layers, frames: await readFrames(map.frames) };
}

/** One field for every time, views into one array. */
async function readFrames(frames) {
  const all = await unpack(frames.data);
  const count = frames.grid.columns * frames.grid.rows;
  return {
    time: frames.time,
    classes: frames.classes,
    fields: frames.time.map((_, i) => new Field(frames.grid, all.subarray(i * count, (i + 1) * count))),
  };
}
