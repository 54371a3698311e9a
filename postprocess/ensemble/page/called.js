// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the page calls its runs: members of an ensemble, or slides, which are no draws of one thing.
import { number } from "../../report/page/format.js";

/** One of them, many of them, and the file of their table. */
export function called(data) {
  return data.run.slides
    ? { one: "slide", many: "slides", table: "slides.csv" }
    : { one: "member", many: "members", table: "members.csv" };
}

/** "Member 12", or its name. */
export function nameOf(data, member) {
  const names = data.members.columns.find((column) => column.kind === "input" && column.name === "name");
  return names ? names.words[names.values[member]] : `Member ${number(member)}`;
}

/** What only a sample has: sensitivity and convergence. */
export function dropSampled() {
  for (const part of ["sensitivity", "convergence"]) {
    document.getElementById(`${part}-section`).remove();
    document.querySelector(`nav a[href="#${part}-section"]`).remove();
  }
}

/** The fixed words of the page, where its runs are slides. */
export function callSlides() {
  const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
  while (texts.nextNode()) {
    const { currentNode: text } = texts;
    if (["SCRIPT", "STYLE", "PRE"].includes(text.parentElement.tagName)) continue;
    text.textContent = text.textContent
      .replace("\u00b7 ensemble", "\u00b7 many slides")
      .replace(/\bMember/g, "Slide")
      .replace(/\bmember/g, "slide");
  }
}
