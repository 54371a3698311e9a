// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Parallel coordinates (Inselberg 1985): an axis for each column, a line for each member.
import { colours } from "../../report/page/charts.js";
import { columnNumber, columnTitle, varies } from "./columns.js";

const mostAxes = 11, // inputs first, then results
  results = ["run_out_m", "flow_area_m2", "deposit_area_m2", "largest_speed_m_s", "volume_outflow_m3", "footprint_csi",
    "footprint_csi_by_cells"];
const top = 46,
  bottom = 24,
  height = 300,
  narrowest = 78; // pixels between axes: below that the box scrolls

export class Parallel {
  constructor(data, selection) {
    Object.assign(this, { selection, members: data.members });
    const { columns } = data.members;
    const shown = columns.filter((column) => varies(column) && column.name !== "name");
    const inputs = shown.filter((column) => column.kind === "input"),
      key = shown.filter((column) => results.includes(column.name));
    this.axes = [...inputs.slice(0, mostAxes - Math.min(key.length, 4)), ...key].slice(0, mostAxes).map((column) => {
      const known = column.values.filter((value) => value !== null);
      return { column, index: columns.indexOf(column), low: Math.min(...known), high: Math.max(...known) };
    });
    this.box = document.getElementById("parallel");
    this.canvas = document.createElement("canvas");
    this.canvas.setAttribute("role", "img");
    this.canvas.setAttribute("aria-label", "Parallel coordinates of the members");
    this.box.append(this.canvas);
    this.listen();
    selection.onChange(() => this.draw());
    new ResizeObserver(() => this.draw()).observe(this.box);
    document.getElementById("clear").addEventListener("click", () => selection.keepAll());
    this.draw();
  }

  x(i) {
    const margin = Math.min(70, 0.5 * this.gap());
    return this.axes.length < 2 ? 0.5 * this.width : margin + (i * (this.width - 2 * margin)) / (this.axes.length - 1);
  }

  gap() {
    return this.width / Math.max(this.axes.length, 1);
  }

  y(axis, value) {
    const span = axis.high - axis.low || 1;
    return top + (height - top - bottom) * (1 - (value - axis.low) / span);
  }

  value(axis, y) {
    const share = 1 - (y - top) / (height - top - bottom);
    return axis.low + Math.min(Math.max(share, 0), 1) * (axis.high - axis.low);
  }

  /** The line of a member; null where a number is missing. */
  line(member) {
    const points = this.axes.map((axis, i) => [this.x(i), axis.column.values[member], axis]);
    if (points.some(([, value]) => value === null)) return null;
    return points.map(([x, value, axis]) => [x, this.y(axis, value)]);
  }

  stroke(member, colour, width) {
    const line = this.line(member);
    if (!line) return;
    const { context } = this;
    Object.assign(context, { strokeStyle: colour, lineWidth: width });
    context.beginPath();
    line.forEach(([x, y], i) => context[i ? "lineTo" : "moveTo"](x, y));
    context.stroke();
  }

  draw() {
    const wide = Math.max(this.box.clientWidth, this.axes.length * narrowest);
    if (!wide || !this.axes.length) return;
    const ratio = Math.max(window.devicePixelRatio, 2);
    this.width = wide;
    this.canvas.width = wide * ratio;
    this.canvas.height = height * ratio;
    this.canvas.style.width = `${wide}px`;
    this.canvas.style.height = `${height}px`;
    this.context = this.canvas.getContext("2d");
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.clearRect(0, 0, wide, height);
    const kept = this.selection.kept(),
      opacity = Math.min(0.6, Math.max(0.06, 25 / Math.max(kept.length, 1)));
    const pale = Math.min(0.1, 12 / this.members.states.length);
    this.members.states.forEach((state, member) => {
      if (state === 1 && !this.selection.keeps(member)) this.stroke(member, `rgba(138,143,152,${pale})`, 1);
    });
    for (const member of kept) this.stroke(member, `rgba(0,114,178,${opacity})`, 1);
    if (this.selection.chosen !== null) this.stroke(this.selection.chosen, colours.orange, 2.5);
    this.axes.forEach((axis, i) => this.drawAxis(axis, this.x(i)));
  }

  drawAxis(axis, x) {
    const { context } = this;
    context.strokeStyle = colours.ink;
    context.lineWidth = 1.2;
    context.beginPath();
    context.moveTo(x, top);
    context.lineTo(x, height - bottom);
    context.stroke();
    const range = this.selection.ranges.get(axis.index);
    if (range) {
      const [from, to] = [this.y(axis, range[1]), this.y(axis, range[0])];
      context.fillStyle = "rgba(213,94,0,0.30)";
      context.fillRect(x - 6, from, 12, to - from);
    }
    Object.assign(context, { fillStyle: colours.ink, font: "11px sans-serif", textAlign: "center" });
    const ends = axis.column.words.length
      ? [axis.column.words[axis.low], axis.column.words[axis.high]]
      : [columnNumber(axis.column, axis.low), columnNumber(axis.column, axis.high)];
    context.fillText(ends[0], x, height - 8);
    context.fillText(ends[1], x, top - 6);
    this.words(columnTitle(axis.column), x);
  }

  /** A title over its axis, in two lines where it is long. */
  words(text, x) {
    const { context } = this,
      most = this.gap() - 8;
    const parts = text.split(/(?<=[._ ])/);
    const lines = [""];
    for (const part of parts)
      if (lines.length < 2 && lines[0] && context.measureText(lines[0] + part).width > most) lines.push(part);
      else lines[lines.length - 1] += part;
    lines.forEach((line, i) => {
      let shown = line.trim();
      while (shown.length > 4 && context.measureText(shown).width > most) shown = `${shown.slice(0, -2)}\u2026`;
      context.fillText(shown, x, 12 + 13 * i);
    });
  }

  place(event) {
    const box = this.canvas.getBoundingClientRect();
    return [event.clientX - box.left, event.clientY - box.top];
  }

  axisAt(x) {
    const i = this.axes.findIndex((_, at) => Math.abs(this.x(at) - x) < 9);
    return i < 0 ? null : this.axes[i];
  }

  listen() {
    let drag = null;
    this.canvas.addEventListener("pointerdown", (event) => {
      const [x, y] = this.place(event),
        axis = this.axisAt(x);
      drag = axis ? { axis, from: y } : null;
      if (!axis) this.chooseAt(x, y);
    });
    this.canvas.addEventListener("pointermove", (event) => {
      if (!drag) return;
      const [, y] = this.place(event);
      if (Math.abs(y - drag.from) < 4) return;
      const ends = [this.value(drag.axis, drag.from), this.value(drag.axis, y)].sort((a, b) => a - b);
      this.selection.keep(drag.axis.index, ends);
      drag.moved = true;
    });
    window.addEventListener("pointerup", () => {
      if (drag && !drag.moved) this.selection.keep(drag.axis.index, null);
      drag = null;
    });
  }

  /** The kept member whose line passes nearest, within some pixels. */
  chooseAt(x, y) {
    let best = null,
      nearest = 8;
    for (const member of this.selection.kept()) {
      const line = this.line(member);
      for (let i = 0; line && i + 1 < line.length; ++i) {
        const [ax, ay] = line[i],
          [bx, by] = line[i + 1];
        if (x < ax || x > bx) continue;
        const distance = Math.abs(ay + ((by - ay) * (x - ax)) / (bx - ax) - y);
        if (distance < nearest) [best, nearest] = [member, distance];
      }
    }
    if (best !== null) this.selection.choose(best);
  }
}
