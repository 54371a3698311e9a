// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of members: sorted by any column, a page of rows at a time.
import { h, number } from "../../report/page/format.js";
import { called } from "./called.js";
import { columnTitle, valueWords } from "./columns.js";

const rowsOnPage = 100,
  states = ["waiting", "counted", "failed", "left out"];

export class MemberTable {
  constructor(data, selection) {
    Object.assign(this, { data, selection, members: data.members });
    this.order = this.members.states.map((_, member) => member);
    this.sorted = { by: null, falling: false };
    this.page = 0;
    this.head();
    selection.onChange(() => this.show(selection.chosen));
    this.rows();
    const { all, shown } = this.members;
    document.getElementById("table-note").textContent =
      (all > shown ? `The first ${number(shown)} of ${number(all)}; ${called(data).table} has all. ` : "") +
      "Click a heading to sort by it, a row for its outline on the map.";
  }

  head() {
    const cell = (words, by) => {
      const button = h("button", { type: "button", "data-by": by }, words.replace(/([._])/g, "$1\u200b")); // may break
      button.addEventListener("click", () => this.sort(by));
      return h("th", { scope: "col", "data-by": by }, button);
    };
    const cells = [cell(called(this.data).one, "member"), cell("state", "state")];
    this.members.columns.forEach((column, i) => cells.push(cell(columnTitle(column), String(i))));
    this.body = h("tbody");
    document.getElementById("table").append(h("table", {}, h("thead", {}, h("tr", {}, cells)), this.body));
  }

  value(member, by) {
    if (by === "member") return member;
    if (by === "state") return this.members.states[member];
    return this.members.columns[Number(by)].values[member];
  }

  /** Rising at the first click, falling at the next; what has no value stands last. */
  sort(by) {
    this.sorted = { by, falling: this.sorted.by === by && !this.sorted.falling };
    const sign = this.sorted.falling ? -1 : 1;
    this.order.sort((a, b) => {
      const [one, other] = [this.value(a, by), this.value(b, by)];
      if (one === null || other === null) return (one === null) - (other === null) || a - b;
      return sign * (one - other) || a - b;
    });
    for (const cell of document.querySelectorAll("#table th"))
      if (cell.dataset.by === by) cell.setAttribute("aria-sort", this.sorted.falling ? "descending" : "ascending");
      else cell.removeAttribute("aria-sort");
    this.page = 0;
    this.rows();
  }

  row(member) {
    const { columns, states: of } = this.members;
    const cells = [number(member), states[of[member]], ...columns.map((column) => valueWords(column, member))];
    const row = h(
      "tr",
      {
        "data-member": member,
        class: member === this.selection.chosen ? "chosen" : of[member] === 2 ? "failed" : null,
      },
      cells.map((words) => h("td", {}, words)),
    );
    row.addEventListener("click", () => this.selection.choose(member));
    return row;
  }

  rows() {
    const from = this.page * rowsOnPage,
      pages = Math.ceil(this.order.length / rowsOnPage);
    this.body.replaceChildren(...this.order.slice(from, from + rowsOnPage).map((member) => this.row(member)));
    const turn = (words, by) => {
      const button = h("button", { type: "button", disabled: this.page + by < 0 || this.page + by >= pages }, words);
      button.addEventListener("click", () => {
        this.page += by;
        this.rows();
      });
      return button;
    };
    const last = Math.min(from + rowsOnPage, this.order.length);
    const words = `Rows ${number(from + 1)} to ${number(last)} of ${number(this.order.length)}`;
    const buttons = pages > 1 ? [turn("Before", -1), turn("Next", 1)] : [];
    document.getElementById("pages").replaceChildren(...buttons, words);
  }

  /** Turns to the page of a member. */
  show(member) {
    if (member !== null) this.page = Math.floor(this.order.indexOf(member) / rowsOnPage);
    this.rows();
  }
}
