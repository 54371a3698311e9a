// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The columns of the table of members, and their numbers in words.
import { number, unitOfPowers } from "../../report/page/format.js";

const titles = {
  run_out_m: "run-out",
  drop_m: "drop",
  flow_reach_m: "reach of the flow",
  centre_travel_m: "travel of the centre of mass",
  reach_ratio: "drop over run-out, H/L",
  flow_area_m2: "area of the flow",
  deposit_area_m2: "area of the deposit",
  volume_released_m3: "released volume",
  volume_final_m3: "final volume",
  volume_outflow_m3: "volume that left",
  largest_thickness_m: "largest thickness",
  p99_thickness_m: "largest thickness, 99 % of its cells below",
  largest_deposit_m: "largest deposit",
  p99_deposit_m: "largest deposit, 99 % of its cells below",
  largest_speed_m_s: "largest speed",
  p99_speed_m_s: "largest speed, 99 % of its cells below",
  largest_pressure_kPa: "largest pressure",
  p99_pressure_kPa: "largest pressure, 99 % of its cells below",
  time_end_s: "simulated time",
  steps: "steps",
  wall_time_s: "wall time",
  edge_cells: "cells at the edge of its domain",
  footprint_csi: "CSI of the footprint",
  footprint_hit_rate: "hit rate of the footprint",
  footprint_false_alarm_ratio: "false alarm ratio of the footprint",
  deposit_csi: "CSI of the deposit",
  footprint_csi_by_cells: "CSI of the footprint, by whole cells",
  deposit_csi_by_cells: "CSI of the deposit, by whole cells",
  deposit_csi_outside_release: "CSI of the deposit outside the release",
};

/** "run-out [m]"; of a key its last part, which has its unit, and the table before it where that tells more. */
export function columnTitle(column) {
  if (column.kind === "input") return column.name.split(".").slice(-2).join(".");
  const unit = unitOfPowers(column.unit);
  return (titles[column.name] ?? column.name) + (unit ? ` [${unit}]` : "");
}

const mostDecimals = 6;

/** Decimals that tell the values of a column apart: three figures of their span, four of the largest at most. */
function decimalsOf(known) {
  if (known.every(Number.isInteger)) return 0;
  const span = Math.max(...known) - Math.min(...known) || Math.abs(known[0]);
  const largest = Math.max(...known.map(Math.abs));
  const wanted = Math.min(3 - Math.ceil(Math.log10(span)), 4 - Math.ceil(Math.log10(largest)));
  return Math.min(Math.max(0, wanted), mostDecimals);
}

/** A number among the values of a column as people read it, with `more` decimals than those. */
export function columnNumber(column, value, more = 0) {
  const known = column.values.filter((one) => one !== null);
  const largest = Math.max(0, ...known.map(Math.abs));
  if (largest > 0 && largest < 1e-3 && Number.isFinite(value)) return value.toExponential(2).replaceAll("-", "\u2212");
  return number(value, known.length ? Math.min(decimalsOf(known) + more, mostDecimals) : 0);
}

/** What stands at a tick of an axis: as many decimals as the steps between ticks have. */
export function tickNumber(value, ticks) {
  const step = ticks.length > 1 ? Math.abs(ticks[1].value - ticks[0].value) : Math.abs(value);
  let decimals = 0;
  while (decimals < mostDecimals && Math.abs(step - Number(step.toFixed(decimals))) > 1e-6 * step) ++decimals;
  return step < 10 ** -mostDecimals && value !== 0 ? value.toExponential(1) : number(value, decimals);
}

/** The value of a member as people read it. */
export function valueWords(column, member) {
  const value = column.values[member];
  if (value === null || value === undefined) return "\u2013";
  return column.words.length ? column.words[value] : columnNumber(column, value);
}

/** Whether a column has something to show: two different numbers at least. */
export function varies(column) {
  const known = column.values.filter((value) => value !== null);
  return known.some((value) => value !== known[0]);
}

/** Fills a list of choices with columns; `chosen` is the name of the first to be shown. */
export function fillChoices(select, columns, chosen, tell) {
  for (const column of columns) {
    const option = document.createElement("option");
    option.value = column.name;
    option.textContent = columnTitle(column);
    option.selected = column.name === chosen;
    select.append(option);
  }
  select.addEventListener("change", tell);
}
