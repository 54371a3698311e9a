// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers and words as people read them.

const thin = "\u2009",
  minus = "\u2212";

/** 36001 -> "36 001" with `decimals` places, thousands apart by thin spaces. */
export function number(value, decimals = 0) {
  if (!Number.isFinite(value)) return "\u2013";
  const text = Math.abs(value).toFixed(decimals);
  const [whole, part] = text.split(".");
  const grouped = whole.length > 4 ? whole.replace(/\B(?=(\d{3})+$)/g, thin) : whole;
  const negative = value < 0 && Number(text) !== 0;
  return (negative ? minus : "") + grouped + (part ? "." + part : "");
}

/** With its unit, set apart by a thin space; degrees stand close. */
export function quantity(value, unit, decimals = 0) {
  const words = unitWords(unit);
  return number(value, decimals) + (words === "" ? "" : words === "\u00b0" ? words : thin + words);
}

export function unitWords(unit) {
  return { m2: "m\u00b2", m3: "m\u00b3", deg: "\u00b0" }[unit] ?? unit;
}

/** A unit as files have it, by powers, in words: "m s-1" -> "m/s", "kg m s-1" -> "kg m/s", "1" -> "". */
export function unitOfPowers(unit) {
  const parts = unit === "1" ? [] : unit.split(" ");
  const over = parts.filter((part) => !part.includes("-")), under = parts.filter((part) => part.includes("-"));
  const words = over.map(unitWords).join(" "), below = under.map((part) => unitWords(part.replace(/-1$|-/, "")));
  return below.length ? `${words || "1"}/${below.join("/")}` : words;
}

/** "36.0 million m³", "22 500 m³": three figures. */
export function volume(value) {
  if (Math.abs(value) >= 999500) {
    const millions = value / 1e6;
    return `${number(millions, Math.abs(millions) < 9.995 ? 2 : Math.abs(millions) < 99.95 ? 1 : 0)} million m\u00b3`;
  }
  const unit = 10 ** Math.max(0, Math.floor(Math.log10(Math.max(Math.abs(value), 1))) - 2);
  return `${number(Math.round(value / unit) * unit)}${thin}m\u00b3`;
}

export function area(value) {
  return value >= 1e6
    ? `${number(value / 1e6, 2)}${thin}km\u00b2`
    : value >= 1e4
      ? `${number(value / 1e4, 1)}${thin}ha`
      : `${number(value)}${thin}m\u00b2`;
}

/** A power of thousand that brings the largest value to 1 ... 1000, with its letter. */
export function scaled(largest) {
  const steps = [
    [1e12, "T"],
    [1e9, "G"],
    [1e6, "M"],
    [1e3, "k"],
  ];
  const found = steps.find(([factor]) => largest >= factor);
  return found ? { factor: found[0], prefix: found[1] } : { factor: 1, prefix: "" };
}

/** An element with attributes, text and children: h("td", {class: "number"}, "3"). */
export function h(name, attributes = {}, ...children) {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) {
    if (value === null || value === undefined || value === false) continue;
    if (key === "style")
      element.style.cssText = value; // a style attribute would need 'unsafe-inline'
    else element.setAttribute(key, value === true ? "" : value);
  }
  for (const child of children.flat()) {
    if (child !== null && child !== undefined) element.append(child);
  }
  return element;
}
