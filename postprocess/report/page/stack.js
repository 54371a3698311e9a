// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables on narrow screens: every row becomes a card whose cells carry the heading of their column (report.css).

/** Gives the cells of every table with headings the words above them; rows over several columns stay as they are. */
export function labelCells(root) {
  for (const table of root.querySelectorAll("table.data")) {
    const heads = [...table.querySelectorAll("thead th")].map((th) => th.textContent);
    if (!heads.length || table.closest("#score")) continue; // scores have rows of their own kind
    table.classList.add("stack");
    for (const row of table.querySelectorAll("tbody tr"))
      [...row.cells].forEach((cell, i) => {
        if (cell.colSpan === 1 && heads[i]) cell.dataset.label = heads[i];
      });
  }
}
