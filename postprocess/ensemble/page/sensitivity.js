// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Sensitivity of a result as bars, with their confidence as lines; and how results settle with the members.
import { colours, lineChart, points } from "../../report/page/charts.js";
import { number } from "../../report/page/format.js";
import { columnNumber, columnTitle, fillChoices } from "./columns.js";

/** Lines from low to high over each bar. */
const whiskers = {
  id: "whiskers",
  afterDatasetsDraw(chart) {
    const { ctx: context, scales } = chart;
    context.save();
    Object.assign(context, { strokeStyle: colours.ink, lineWidth: 1.3 });
    chart.data.datasets.forEach((dataset, d) =>
      chart.getDatasetMeta(d).data.forEach((bar, i) => {
        const { low, high } = dataset.limits[i];
        if (low === null || high === null) return;
        const [from, to] = [scales.x.getPixelForValue(low), scales.x.getPixelForValue(high)];
        context.beginPath();
        context.moveTo(from, bar.y);
        context.lineTo(to, bar.y);
        for (const end of [from, to]) {
          context.moveTo(end, bar.y - 3);
          context.lineTo(end, bar.y + 3);
        }
        context.stroke();
      }),
    );
    context.restore();
  },
};

const barColours = [colours.blue, colours.orange, colours.green];

/** "solve.base.friction_angle_deg" in two lines at most. */
function keyWords(key, narrow) {
  const parts = key.split(".");
  return narrow ? parts.at(-1).match(/.{1,16}/g) : parts.slice(-2).join(".");
}

function notes(found, data) {
  const parts = [`Of ${number(found.members)} members.`];
  const measures = new Set(found.indices.map((index) => index.measure));
  if (measures.has("sobol_first_order"))
    parts.push(
      "First order: share of the variance that a key explains by itself; total: with all that it does together with " +
        "others. Lines: 95 %, bootstrapped. Small negative values are sampling error.",
    );
  if (measures.has("spearman_rank_correlation"))
    parts.push(
      `The design \u201c${data.run.design}\u201d gives no Sobol indices (design = "sensitivity" does): these are ` +
        "correlations of ranks, 1 where the result only rises with the key and \u22121 where it only falls. " +
        "Lines: 95 %. R2-HSIC is 0 where the result does not depend on the key and 1 at most, whatever the form.",
    );
  if (measures.has("swing")) parts.push("Range of the result while the key alone goes over its levels.");
  if (found.note) parts.push(`${found.note[0].toUpperCase()}${found.note.slice(1)}.`);
  return parts.join(" ");
}

export class Sensitivity {
  constructor(data) {
    this.data = data;
    const names = data.sensitivity.filter((found) => found.indices.length).map((found) => found.result);
    const columns = data.members.columns.filter((column) => names.includes(column.name));
    this.of = document.getElementById("sensitivity-of");
    fillChoices(this.of, columns, columns[0]?.name, () => this.draw());
    if (columns.length) this.draw();
    else {
      document.getElementById("sensitivity-frame").hidden = true;
      const why = data.sensitivity[0]?.note ?? "there are no results";
      document.getElementById("sensitivity-note").textContent = `There is none to show: ${why}.`;
    }
  }

  draw() {
    const found = this.data.sensitivity.find(({ result }) => result === this.of.value);
    const keys = [...new Set(found.indices.map((index) => index.key))],
      measures = [...new Set(found.indices.map((index) => index.measure))];
    const frame = document.getElementById("sensitivity-frame");
    frame.style.height = `${90 + keys.length * (16 + 16 * measures.length)}px`;
    const datasets = measures.map((measure, m) => {
      const of = keys.map((key) => found.indices.find((index) => index.key === key && index.measure === measure));
      return {
        label: of.find(Boolean).title,
        data: of.map((index) => index?.value ?? null),
        limits: of.map((index) => ({ low: index?.low ?? null, high: index?.high ?? null })),
        backgroundColor: barColours[m],
      };
    });
    const ends = found.indices.flatMap(({ value, low, high }) => [value, low ?? value, high ?? value]);
    const span = { suggestedMin: Math.min(0, ...ends), suggestedMax: Math.max(0, ...ends) };
    this.chart?.destroy();
    this.chart = new Chart(document.getElementById("sensitivity"), {
      type: "bar",
      data: { labels: keys.map((key) => keyWords(key, frame.clientWidth < 560)), datasets },
      options: {
        indexAxis: "y",
        maintainAspectRatio: false,
        scales: {
          x: { grid: { color: "#e6e8eb" }, ticks: { maxRotation: 0 }, ...span },
          y: { grid: { display: false } },
        },
        plugins: {
          legend: { align: "start" },
          tooltip: {
            callbacks: {
              label: (item) => {
                const { low, high } = item.dataset.limits[item.dataIndex];
                const limits = low === null ? "" : ` (${number(low, 3)} to ${number(high, 3)})`;
                return `${item.dataset.label}: ${number(item.raw, 3)}${limits}`;
              },
            },
          },
        },
      },
      plugins: [whiskers],
    });
    document.getElementById("sensitivity-note").textContent = notes(found, this.data);
  }
}

export class Convergence {
  constructor(data) {
    this.data = data;
    const names = data.convergence.filter((of) => of.members.length).map((of) => of.name);
    this.columns = data.members.columns.filter((column) => names.includes(column.name));
    this.of = document.getElementById("convergence-of");
    fillChoices(this.of, this.columns, this.columns[0]?.name, () => this.draw());
    if (this.columns.length) this.draw();
  }

  draw() {
    const column = this.columns.find(({ name }) => name === this.of.value);
    const { members, mean, error } = this.data.convergence.find(({ name }) => name === this.of.value);
    const shifted = (sign) => mean.map((value, i) => (error[i] === null ? null : value + sign * error[i]));
    const box = document.getElementById("convergence");
    this.chart?.destroy();
    box.replaceChildren();
    const pale = "rgba(0,114,178,0.16)";
    this.chart = lineChart(box, {
      id: "convergence-chart",
      title: `Mean of the first members: ${columnTitle(column)}`,
      height: 270,
      x: "members",
      y: columnTitle(column),
      zero: false,
      lines: [
        { label: "mean", data: points(members, mean), colour: colours.blue },
        { label: "plus its standard error", data: points(members, shifted(1)), colour: colours.sky, width: 1 },
        {
          label: "less its standard error",
          data: points(members, shifted(-1)),
          colour: colours.sky,
          width: 1,
          fill: "-1",
          fillColour: pale,
        },
      ],
    });
    const last = mean.length - 1;
    const some = error[last] === null ? "" : ` \u00b1 ${columnNumber(column, error[last], 1)}`;
    document.getElementById("convergence-note").textContent =
      `All ${number(members[last])} members: ${columnNumber(column, mean[last], 1)}${some}. ` +
      "Members come in their order. " +
      "The standard error is that of independent draws: a stratified design usually settles sooner, a sensitivity " +
      "design later.";
  }
}
