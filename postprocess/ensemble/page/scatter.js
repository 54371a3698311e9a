// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scatter of two columns, and the histogram of one.
import { colours } from "../../report/page/charts.js";
import { columnNumber, columnTitle, fillChoices, tickNumber, valueWords, varies } from "./columns.js";

function axis(column, zero) {
  return {
    type: "linear",
    beginAtZero: zero ?? false,
    title: { display: true, text: column ? columnTitle(column) : "number" },
    grid: { color: "#e6e8eb" },
    ticks: {
      maxRotation: 0,
      autoSkipPadding: 14,
      includeBounds: false,
      precision: column ? undefined : 0, // members are counted
      callback: (value, _, ticks) =>
        column?.words.length ? (column.words[value] ?? "") : tickNumber(value, ticks),
    },
  };
}

export class Scatter {
  constructor(data, selection) {
    Object.assign(this, { selection, members: data.members });
    const columns = this.members.columns.filter(varies);
    this.byName = new Map(columns.map((column) => [column.name, column]));
    const input = columns.find((column) => column.kind === "input" && column.name !== "name") ?? columns[0];
    const result = columns.find((column) => column.kind !== "input") ?? columns[0];
    this.x = document.getElementById("scatter-x");
    this.y = document.getElementById("scatter-y");
    fillChoices(this.x, columns, input?.name, () => this.build());
    fillChoices(this.y, columns, result?.name, () => this.build());
    selection.onChange(() => this.draw());
    if (columns.length) this.build();
  }

  points(wanted) {
    const x = this.byName.get(this.x.value),
      y = this.byName.get(this.y.value);
    return this.members.states
      .map((_, member) => ({ x: x.values[member], y: y.values[member], member }))
      .filter(({ x: a, y: b, member }) => a !== null && b !== null && wanted(member));
  }

  build() {
    this.chart?.destroy();
    const x = this.byName.get(this.x.value),
      y = this.byName.get(this.y.value);
    const style = (colour, radius) => ({
      backgroundColor: colour,
      borderColor: colour,
      pointRadius: radius,
      pointHitRadius: 4,
      data: [],
    });
    this.chart = new Chart(document.getElementById("scatter"), {
      type: "scatter",
      data: {
        datasets: [
          { label: "chosen", ...style(colours.orange, 7) },
          { label: "kept", ...style("rgba(0,114,178,0.55)", 3) },
          { label: "others", ...style("rgba(138,143,152,0.25)", 2.5) },
        ],
      },
      options: {
        maintainAspectRatio: false,
        interaction: { mode: "nearest", intersect: true },
        scales: { x: axis(x), y: axis(y) },
        plugins: {
          legend: { display: false },
          tooltip: {
            callbacks: {
              label: ({ raw }) => `member ${raw.member}: ${valueWords(x, raw.member)}, ${valueWords(y, raw.member)}`,
            },
          },
        },
        onClick: (event, active) => {
          if (active.length)
            this.selection.choose(this.chart.data.datasets[active[0].datasetIndex].data[active[0].index].member);
        },
      },
    });
    this.draw();
  }

  draw() {
    if (!this.chart) return;
    const [chosen, kept, others] = this.chart.data.datasets,
      { selection } = this;
    chosen.data = this.points((member) => member === selection.chosen);
    kept.data = this.points((member) => selection.keeps(member));
    others.data = this.points((member) => !selection.keeps(member));
    this.chart.update("none");
  }
}

/** Bins by the rule of Freedman and Diaconis (1981), 5 to 40 of them. */
export function binsOf(values) {
  const sorted = [...values].sort((a, b) => a - b),
    count = sorted.length;
  const low = sorted[0],
    high = sorted[count - 1];
  const quartile = (share) => sorted[Math.min(count - 1, Math.floor(share * count))];
  const width = (2 * (quartile(0.75) - quartile(0.25))) / Math.cbrt(count);
  const wanted = width > 0 ? Math.ceil((high - low) / width) : 1;
  const bins = Math.min(Math.max(wanted, 5), 40),
    step = (high - low) / bins || 1;
  const counts = new Array(bins).fill(0);
  for (const value of sorted) counts[Math.min(bins - 1, Math.floor((value - low) / step))] += 1;
  return { low, step, counts };
}

export class Histogram {
  constructor(data, selection) {
    Object.assign(this, { selection, members: data.members });
    const columns = this.members.columns.filter((column) => varies(column) && !column.words.length);
    this.byName = new Map(columns.map((column) => [column.name, column]));
    this.of = document.getElementById("histogram-of");
    const result = columns.find((column) => column.kind !== "input") ?? columns[0];
    fillChoices(this.of, columns, result?.name, () => this.draw());
    selection.onChange(() => this.draw());
    if (columns.length) this.draw();
  }

  draw() {
    const column = this.byName.get(this.of.value);
    const kept = this.selection.kept().filter((member) => column.values[member] !== null);
    const known = kept.map((member) => column.values[member]);
    const bins = known.length ? binsOf(known) : { low: 0, step: 1, counts: [] };
    const points = bins.counts.map((y, i) => ({ x: bins.low + (i + 0.5) * bins.step, y }));
    const chosen = column.values[this.selection.chosen] ?? null;
    const inside = Math.min(bins.counts.length - 1, Math.floor((chosen - bins.low) / bins.step));
    const fill = points.map((_, i) => (chosen !== null && i === inside ? colours.orange : colours.sky));
    const end = bins.low + bins.counts.length * bins.step || 1;
    this.chart?.destroy();
    this.chart = new Chart(document.getElementById("histogram"), {
      type: "bar",
      data: { datasets: [{ data: points, backgroundColor: fill, barPercentage: 1, categoryPercentage: 0.96 }] },
      options: {
        maintainAspectRatio: false,
        scales: {
          x: { ...axis(column), offset: false, grid: { offset: false }, min: bins.low, max: end },
          y: axis(null, true),
        },
        plugins: {
          legend: { display: false },
          tooltip: {
            callbacks: {
              title: ([item]) => {
                const low = bins.low + item.dataIndex * bins.step;
                return `${columnNumber(column, low, 1)} to ${columnNumber(column, low + bins.step, 1)}`;
              },
              label: (item) => `${item.raw.y} members`,
            },
          },
        },
      },
    });
  }
}
