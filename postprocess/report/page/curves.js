// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Profile along the thalweg, and numbers over time.
import { colours, lineChart, points } from "./charts.js";
import { number, scaled, unitOfPowers } from "./format.js";

function text(id, words) {
  document.getElementById(id).textContent = words;
}

/** Three charts above one another: elevation, thickness, speed. `pointAt(i)` is told which vertex is looked at. */
export function drawProfile(data, pointAt) {
  const profile = data.profile,
    box = document.getElementById("profile");
  if (!profile) {
    text("profile-note", "No profile: the run has neither a release nor a deposit to draw a line through.");
    return;
  }
  const s = profile.distance,
    survey = data.run.survey?.name;
  const common = { x: "Distance along the thalweg [m]", min: 0, max: s[s.length - 1], onHover: pointAt };
  const line = (label, key, more) => ({ label, data: points(s, profile[key]), ...more });
  const visible = Math.min(0.05, data.run.thresholds.deposit); // [m] of a layer on a profile of hundreds
  // A surface is drawn where there is a layer to see; elsewhere it would hide the bed.
  const surface = (key, layer) => profile[key].map((z, i) => (profile[layer][i] > visible ? z : NaN));
  const elevations = [
    // the first is drawn on top
    {
      label: "Deposit, simulated",
      data: points(s, surface("deposit_surface", "deposit")),
      colour: colours.orange,
      fill: "+1",
      fillColour: "rgba(213, 94, 0, 0.35)",
    },
    line("Bed", "bed", { colour: colours.ink, width: 1.5 }),
    line("Surface before", "before", { colour: colours.grey, width: 1.5, dashes: [5, 3] }),
  ];
  const thickness = [
    line("Deposit, simulated", "deposit", {
      colour: colours.orange,
      fill: "origin",
      fillColour: "rgba(213, 94, 0, 0.18)",
    }),
    line("Peak, simulated", "peak", { colour: colours.yellow, dashes: [6, 3] }),
  ];
  if (profile.surveyed) {
    const after = data.run.survey.is_change ? profile.surveyed_surface : surface("surveyed_surface", "surveyed");
    elevations.unshift({
      label: `Surface after, ${survey}`,
      data: points(s, after),
      colour: colours.blue,
      dashes: [8, 4],
    });
    thickness.unshift(line(`Deposit, ${survey}`, "surveyed", { colour: colours.blue, dashes: [8, 4] }));
  }
  lineChart(box, {
    ...common,
    id: "profile-elevation",
    title: "Elevation",
    y: "Elevation [m]",
    height: 300,
    lines: elevations,
    zero: false,
  });
  lineChart(box, {
    ...common,
    id: "profile-thickness",
    title: "Thickness, vertical",
    y: "Thickness [m]",
    height: 220,
    lines: thickness,
  });
  lineChart(box, {
    ...common,
    id: "profile-speed",
    title: "Peak speed",
    y: "Speed [m/s]",
    height: 180,
    lines: [line("Peak speed", "speed", { colour: colours.green })],
  });
  text("profile-note", profileNote(profile));
}

function profileNote(profile) {
  const z = [...profile.before, ...profile.bed].filter(Number.isFinite),
    s = profile.distance;
  const drop = Math.max(...z) - Math.min(...z),
    length = s[s.length - 1];
  const origin = profile.given ? "The thalweg is the line that the recipe gives" : "The thalweg was found from the run";
  return (
    `${origin}${profile.origin ? ` (${profile.origin})` : ""}: ${number(length)} m long, over ${number(drop)} m ` +
    `of relief. ` +
    "Values are those on the line itself, not the largest across it. Moving over a curve marks the place on the map."
  );
}

/** Brings columns to a readable unit: {factor, prefix} by their largest value. */
function unitOf(...columns) {
  return scaled(Math.max(0, ...columns.flat().filter(Number.isFinite).map(Math.abs)));
}

function curve(label, time, values, factor, more) {
  return {
    label,
    data: points(
      time,
      values.map((v) => v / factor),
    ),
    ...more,
  };
}

function energyChart(box, history) {
  const t = history.time_s,
    entered = history.inflow_energy_J, // of an inflow, with the kinetic energy that it came with
    released = history.potential_J.map((e, i) => history.potential_J[0] - e + (entered ? entered[i] : 0));
  const since = entered ? "it entered" : "the start";
  const { factor, prefix } = unitOf(history.kinetic_J, released);
  const lines = [
    curve("Kinetic", t, history.kinetic_J, factor, { colour: colours.orange }),
    curve(`Potential, given up since ${since}`, t, released, factor, { colour: colours.grey, dashes: [6, 3] }),
  ];
  if (history.bed_loss_J) lines.push(curve("Lost to the bed", t, history.bed_loss_J, factor, { colour: colours.blue }));
  if (history.plastic_loss_J)
    lines.push(curve("Lost to plastic flow", t, history.plastic_loss_J, factor, { colour: colours.green }));
  lineChart(box, { id: "series-energy", title: "Energy", x: "Time [s]", y: `Energy [${prefix}J]`, height: 240, lines });
  if (!kineticLiesFlat(history.kinetic_J, released)) return;
  const own = unitOf(history.kinetic_J);
  lineChart(box, {
    id: "series-kinetic",
    title: "Kinetic energy",
    x: "Time [s]",
    y: `Energy [${own.prefix}J]`,
    height: 240,
    lines: [curve("Kinetic", t, history.kinetic_J, own.factor, { colour: colours.orange })],
  });
}

/** True where kinetic energy would lie flat beside the potential one. */
function kineticLiesFlat(kinetic, released) {
  return Math.max(...kinetic) < 0.1 * Math.max(...released);
}

/** One line after another: colours first, then dashes. */
function lineStyle(i) {
  const order = [colours.orange, colours.blue, colours.green, colours.violet, colours.yellow, colours.sky, colours.ink];
  const dashes = [[], [6, 3], [2, 3]];
  return { colour: order[i % order.length], dashes: dashes[Math.floor(i / order.length) % dashes.length] };
}

/** What stands along an axis: a long quantity is in the title already, where it has room. */
function axisWords(quantity, unit) {
  return quantity.length + unit.length <= 30 || !unit ? `${quantity} ${unit}` : unit;
}

/** A chart for every quantity that is measured at places, such as gauges and obstacles: a line for each place. */
function placeCharts(box, history, columns) {
  const charts = new Map();
  for (const column of columns) {
    const key = `${column.quantity} [${column.unit}]`;
    charts.set(key, [...(charts.get(key) ?? []), column]);
  }
  for (const [first, ...others] of charts.values()) {
    const all = [first, ...others], values = all.map((column) => history[column.name]);
    const { factor, prefix } = /^[JNW]/.test(first.unit) ? unitOf(...values) : { factor: 1, prefix: "" };
    const known = values.flat().filter(Number.isFinite), unit = unitOfPowers(first.unit);
    const measured = first.quantity[0].toUpperCase() + first.quantity.slice(1);
    lineChart(box, { id: `series-${first.quantity.replace(/[^a-z]+/gi, "-")}`, x: "Time [s]", height: 240,
      title: others.length ? measured : `${measured}, ${first.place}`, // one line has no legend
      y: axisWords(measured, unit ? `[${prefix}${unit}]` : ""), zero: Math.min(...known) < 0.5 * Math.max(...known),
      lines: all.map((column, i) => curve(column.place, history.time_s, values[i], factor, lineStyle(i))) });
  }
}

/** The front stays where it is until the end of the run. */
function frontPoints(front) {
  const last = front.distance[front.distance.length - 1];
  return points([...front.time, Math.max(front.until, front.time[front.time.length - 1])], [...front.distance, last]);
}

/** Energy, speed, volume in motion, front, then what was measured at places. */
export function drawSeries(data) {
  const { history, front, motion } = data.series,
    box = document.getElementById("series"),
    notes = [];
  if (history.time_s?.length > 1) {
    energyChart(box, history);
    const speed = [
      { label: "Largest of any point", data: points(history.time_s, history.speed_max_m_s), colour: colours.green },
    ];
    if (motion)
      speed.push({
        label: "Mean of what moves",
        data: points(motion.time, motion.mean_speed),
        colour: colours.violet,
        dots: !motion.from_history,
        dashes: [6, 3],
      });
    lineChart(box, { id: "series-speed", title: "Speed", x: "Time [s]", y: "Speed [m/s]", height: 240, lines: speed });
  }
  if (motion) {
    const largest = Math.max(...motion.volume),
      factor = largest >= 1e6 ? 1e6 : largest >= 1e4 ? 1e3 : 1;
    const prefix = { 1: "", 1e3: "thousand ", 1e6: "million " }[factor];
    lineChart(box, {
      id: "series-motion",
      title: "Volume in motion",
      x: "Time [s]",
      y: `Volume [${prefix}m\u00b3]`,
      height: 240,
      lines: [curve("In motion", motion.time, motion.volume, factor, {
        colour: colours.blue,
        dots: !motion.from_history,
      })],
    });
    notes.push(
      `In motion: material points faster than ${motion.faster_than} m/s, at the ${motion.time.length} ` +
        (motion.from_history ? "records of the history." : "frames the run wrote; its history does not have it."),
    );
  }
  if (front) {
    lineChart(box, {
      id: "series-front",
      title: "Front along the thalweg",
      x: "Time [s]",
      y: "Distance [m]",
      height: 240,
      lines: [{ label: "Front", data: frontPoints(front), colour: colours.violet }],
    });
    notes.push(
      `Front: farthest place along the thalweg that the flow has reached, thicker than ${front.threshold} m, by the ` +
        `map of arrival times.`,
    );
  }
  placeCharts(box, history, data.series.at_places);
  if (!box.children.length) notes.push("The run holds no history.");
  text("series-note", notes.join(" "));
}
