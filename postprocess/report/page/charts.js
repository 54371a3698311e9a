// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Charts of the report, drawn by Chart.js: lines over a linear x, all of one make.
import { h, number } from "./format.js";

// Okabe & Ito's colours, which every common colour blindness keeps apart.
export const colours = {
  ink: "#1a1c20",
  grey: "#8a8f98",
  orange: "#d55e00",
  yellow: "#e69f00",
  blue: "#0072b2",
  sky: "#56b4e9",
  green: "#009e73",
  violet: "#8c1a73",
};

const axisWidth = 66; // the same for all, so that charts above one another share their x

function setDefaults() {
  Chart.defaults.font.family = '"Segoe UI", "Helvetica Neue", Arial, "Liberation Sans", "DejaVu Sans", sans-serif';
  Chart.defaults.font.size = 12;
  Chart.defaults.color = "#33363c";
  Chart.defaults.animation = false;
  Chart.defaults.devicePixelRatio = Math.max(window.devicePixelRatio, 2); // sharp on paper too
}
setDefaults();

/** Pairs {x, y} of two columns; gaps where y is missing. */
export function points(x, y) {
  return x.map((value, i) => ({ x: value, y: y[i] ?? NaN }));
}

/** A line: {label, data, colour, dashes, fill, dots, width}. */
function dataset(line) {
  return {
    label: line.label,
    data: line.data,
    borderColor: line.colour,
    backgroundColor: line.fillColour ?? line.colour,
    borderWidth: line.width ?? 2,
    borderDash: line.dashes ?? [],
    pointRadius: line.dots ? 2.5 : 0,
    pointHitRadius: 8,
    fill: line.fill ?? false,
    parsing: false,
    normalized: true,
    stepped: false,
    spanGaps: false,
  };
}

function axis(title, extra) {
  return {
    type: "linear",
    title: { display: true, text: title },
    grid: { color: "#e6e8eb" },
    ...extra,
    ticks: {
      includeBounds: false,
      callback: (value) => number(value, decimalsOf(value)),
      maxRotation: 0,
      autoSkipPadding: 16,
    },
  };
}

function decimalsOf(value) {
  return Number.isInteger(value) ? 0 : Math.min(Math.max(0, -Math.floor(Math.log10(Math.abs(value) % 1 || 1))), 3);
}

/** A sample of each line, dashes and all. */
function legendLabels(chart) {
  return chart.data.datasets.map((d, i) => ({
    text: d.label,
    strokeStyle: d.borderColor,
    fillStyle: d.borderColor,
    lineDash: d.borderDash,
    lineWidth: d.borderWidth,
    pointStyle: "line",
    hidden: !chart.isDatasetVisible(i),
    datasetIndex: i,
  }));
}

/** Put a chart into `box`. `spec`: {id, title, height, x, y, lines, min, max, onHover, zero}. */
export function lineChart(box, spec) {
  const canvas = h("canvas", { id: spec.id, role: "img", "aria-label": spec.title });
  const frame = h("div", { class: "canvas-frame", style: `height:${spec.height}px` }, canvas);
  box.append(h("div", { class: "chart" }, h("h3", {}, spec.title), frame));
  const y = axis(spec.y, {
    beginAtZero: spec.zero ?? true,
    afterFit: (scale) => {
      scale.width = axisWidth;
    },
  });
  return new Chart(canvas, {
    type: "line",
    data: { datasets: spec.lines.map(dataset) },
    options: {
      maintainAspectRatio: false,
      interaction: { mode: "nearest", axis: "x", intersect: false },
      scales: { x: axis(spec.x, { min: spec.min, max: spec.max }), y },
      plugins: {
        legend: {
          display: spec.lines.length > 1,
          align: "start",
          labels: { usePointStyle: true, pointStyleWidth: 30, generateLabels: legendLabels },
        },
        tooltip: {
          callbacks: {
            title: (items) => `${spec.x}: ${number(items[0].parsed.x, 1)}`,
            label: (item) => `${item.dataset.label}: ${number(item.parsed.y, 2)}`,
          },
        },
      },
      onHover: spec.onHover ? (event, active) => spec.onHover(active[0]?.index) : undefined,
    },
  });
}
