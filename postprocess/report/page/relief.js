// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The section with the view in 3-D: what lies on the ground, the player, the pictures for paper. Where the browser
// draws no WebGL, a line says so and the map above stands for it.
import { h, number } from "./format.js";
import { blending } from "./paint.js";
import { swatches } from "./panel.js";
import { ReliefGrid } from "./relief_grid.js";
import { canDraw, ReliefScene } from "./relief_scene.js";

const north =
  '<svg width="26" height="36" viewBox="0 0 26 36" role="img" aria-label="North"><path d="M13 1 L22 34 L13 27 Z" ' +
  'fill="#b9bcc1" stroke="#1a1c20"/><path d="M13 1 L4 34 L13 27 Z" fill="#1a1c20" stroke="#1a1c20"/></svg><br>N';

export class Relief {
  constructor(data, fields, map, lines) {
    Object.assign(this, { data, fields, map, lines, frame: 0 });
    this.box = document.getElementById("relief-section");
    this.canvas = document.getElementById("relief");
    if (!data.map.relief) return this.leave();
    if (!canDraw()) return this.giveUp("This browser draws no WebGL");
    this.waitUntilSeen();
  }

  leave() {
    this.box.remove();
    document.getElementById("relief-link").remove();
  }

  giveUp(why) {
    this.stop?.();
    this.scene = null;
    document.getElementById("relief-view")?.remove();
    const note = document.getElementById("relief-note");
    note.textContent = `${why}, so that the view in three dimensions is left out. The map above shows the same flow.`;
    this.box.classList.add("screen-only"); // paper has the maps
  }

  /** Nothing is drawn before the section comes near the screen, or goes to the printer. */
  waitUntilSeen() {
    const watch = new IntersectionObserver(
      (entries) => {
        if (entries.some((entry) => entry.isIntersecting)) this.begin();
      },
      { rootMargin: "200px" },
    );
    watch.observe(this.box);
    this.watch = watch;
    window.addEventListener("beforeprint", () => this.print());
  }

  begin() {
    if (this.scene || this.failed) return;
    this.watch.disconnect();
    try {
      this.relief = new ReliefGrid(this.fields);
      this.scene = new ReliefScene(this.canvas, this.relief);
    } catch (error) {
      this.failed = true;
      this.giveUp(`WebGL does not draw this (${error.message})`);
      return;
    }
    this.canvas.addEventListener("webglcontextlost", () => this.giveUp("The graphics card gave up"));
    this.followSize();
    this.makeControls();
    this.makePlayer();
    this.makeCompass();
    this.drape("none");
    this.seek(this.relief.flows.length - 1);
  }

  followSize() {
    const fit = () => {
      const width = this.canvas.parentElement.clientWidth;
      if (!width || !this.scene) return;
      const height = Math.round(Math.max(Math.min(0.62 * width, 0.75 * window.innerHeight), Math.min(width, 300)));
      this.canvas.style.height = `${height}px`;
      this.scene.resize(width, height);
      if (!this.touched) this.scene.look(this.scene.angle);
    };
    new ResizeObserver(fit).observe(this.canvas.parentElement);
    fit();
  }

  /** The page scrolls past the view until it is clicked, and again once the pointer has left it. */
  makeControls() {
    const { canvas } = this,
      turns = (on) => {
        this.scene.controls.enabled = on;
        canvas.classList.toggle("turns", on);
      };
    canvas.addEventListener("pointerdown", (event) => {
      this.touched = true;
      if (event.pointerType === "mouse") turns(true);
    });
    canvas.addEventListener("click", () => turns(true));
    canvas.addEventListener("mouseleave", () => turns(false));
    document.addEventListener("pointerdown", (event) => event.target !== canvas && turns(false));
    canvas.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-0.15, 1], ArrowRight: [0.15, 1], "+": [0, 1.15], "-": [0, 1 / 1.15] }[event.key];
      if (!step) return;
      event.preventDefault();
      this.touched = true;
      this.scene.turn(...step);
    });
    const times = document.getElementById("relief-times");
    times.addEventListener("change", () => this.scene.exaggerate(Number(times.value)));
    const choice = document.getElementById("relief-ground");
    choice.append(h("option", { value: "none" }, "Hillshade"));
    for (const layer of this.fields.layers) choice.append(h("option", { value: layer.id }, layer.title));
    choice.addEventListener("change", () => this.drape(choice.value));
    const flow = document.getElementById("relief-flow");
    flow.addEventListener("change", () => {
      this.scene.flow.visible = flow.checked;
      this.scene.draw();
    });
  }

  makePlayer() {
    const slider = document.getElementById("relief-time"),
      last = this.relief.flows.length - 1;
    const legend = document.getElementById("relief-legend");
    legend.replaceChildren(h("h3", {}, "Flow, thickness [m]"), swatches(this.relief.classes));
    if (last === 0) {
      document.getElementById("relief-player").remove();
      this.stop = () => {};
      return;
    }
    slider.max = last;
    slider.addEventListener("input", () => {
      this.stop();
      this.seek(Number(slider.value));
    });
    document.getElementById("relief-play").addEventListener("click", () => (this.timer ? this.stop() : this.play()));
  }

  seek(frame) {
    this.frame = frame;
    const { flows, classes } = this.relief;
    this.scene.showFrame(frame, this.map.painter.paint(flows[frame], classes, "smooth", { most: 900 }));
    const { times } = this.relief;
    if (times.length < 2) return;
    const decimals = times.every((t) => Number.isInteger(t)) ? 0 : 1;
    document.getElementById("relief-time").value = frame;
    document.getElementById("relief-time-label").textContent =
      `t = ${number(times[frame], decimals)} of ${number(times[times.length - 1], decimals)}\u2009s`;
  }

  /** All frames in about six seconds, from the start again once the end is reached. */
  play() {
    const count = this.relief.times.length;
    if (this.frame === count - 1) this.seek(0);
    this.setButton(true);
    this.timer = setInterval(
      () => {
        if (this.frame + 1 < count) this.seek(this.frame + 1);
        if (this.frame + 1 >= count) this.stop();
      },
      Math.min(Math.max(6000 / count, 60), 500),
    );
  }

  stop() {
    clearInterval(this.timer);
    this.timer = null;
    this.setButton(false);
  }

  setButton(playing) {
    const button = document.getElementById("relief-play");
    if (!button) return;
    button.textContent = playing ? "\u275a\u275a" : "\u25b6";
    button.setAttribute("aria-label", playing ? "Pause" : "Play the flow over time in 3-D");
  }

  makeCompass() {
    const compass = document.getElementById("relief-north");
    compass.innerHTML = north;
    this.scene.drawn = () => {
      compass.firstElementChild.style.transform = `rotate(${this.scene.angle + Math.PI / 2}rad)`;
    };
  }

  /** The hillshade with a layer and the outlines on it, as the ground's skin. */
  drape(id) {
    const { grid } = this.relief,
      layer = this.fields.layers.find((one) => one.id === id),
      canvas = document.createElement("canvas"),
      scale = Math.min(Math.max(Math.round(1600 / Math.max(grid.columns, grid.rows)), 1), 80);
    canvas.width = grid.columns * scale;
    canvas.height = grid.rows * scale;
    const context = canvas.getContext("2d"),
      perMetre = scale / grid.cell,
      top = grid.south + grid.rows * grid.cell;
    const put = (picture, { grid: g }) => {
      const size = [g.columns * g.cell * perMetre, g.rows * g.cell * perMetre];
      context.drawImage(
        picture,
        (g.west - grid.west) * perMetre,
        (top - g.south - g.rows * g.cell) * perMetre,
        ...size,
      );
    };
    put(this.map.ground, this.fields.ground.shade);
    if (layer) put(this.map.painter.paint(layer.field, layer.classes, blending(layer), { most: 1100 }), layer.field);
    for (const line of this.lines.filter((one) => one.id.startsWith("survey") || one.id === "release"))
      this.draw(context, line, ([x, y]) => [(x - grid.west) * perMetre, (top - y) * perMetre]);
    this.scene.drape(canvas);
  }

  draw(context, { lines, style }, place) {
    Object.assign(context, { strokeStyle: style.colour, lineWidth: 1.6 * style.width, lineJoin: "round" });
    context.setLineDash((style.dashes ?? []).map((d) => 1.6 * d));
    context.beginPath();
    for (const line of lines) line.forEach((at, i) => context[i ? "lineTo" : "moveTo"](...place(at)));
    context.stroke();
  }

  /** For paper: the flow on its way, and at the end. */
  print() {
    this.begin();
    if (!this.scene) return;
    const shown = this.frame,
      last = this.relief.flows.length - 1,
      instants = last > 1 ? [Math.round(last / 3), last] : [last];
    document.getElementById("relief-plates").replaceChildren(
      ...instants.map((frame) => {
        this.seek(frame);
        const time = this.relief.times[frame];
        const words = time === null ? "Deposit" : `Flow, thickness [m] at t = ${number(time, 1)}\u2009s`;
        const picture = h("img", { src: this.scene.picture(), alt: words });
        return h("figure", { class: "plate" }, picture, h("figcaption", {}, words));
      }),
    );
    this.seek(shown);
  }
}
