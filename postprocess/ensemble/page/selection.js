// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which member is looked at, and which are kept: what the map, the charts and the table have in common.

export class Selection {
  constructor(members) {
    this.members = members;
    this.chosen = null; // number of a member
    this.ranges = new Map(); // column -> [low, high]
    this.listeners = [];
  }

  /** Calls `tell(selection)` whenever something changes. */
  onChange(tell) {
    this.listeners.push(tell);
  }

  tell() {
    for (const listener of this.listeners) listener(this);
  }

  choose(member) {
    this.chosen = this.chosen === member ? null : member;
    this.tell();
  }

  /** Keep the members whose `column` lies within; null takes that back. */
  keep(column, range) {
    if (range) this.ranges.set(column, range);
    else this.ranges.delete(column);
    this.tell();
  }

  keepAll() {
    this.ranges.clear();
    this.tell();
  }

  /** True for members that are counted and lie within all ranges. */
  keeps(member) {
    if (this.members.states[member] !== 1) return false;
    for (const [column, [low, high]] of this.ranges) {
      const value = this.members.columns[column].values[member];
      if (value === null || value < low || value > high) return false;
    }
    return true;
  }

  /** Numbers of the members that are kept. */
  kept() {
    return this.members.states.map((_, member) => member).filter((member) => this.keeps(member));
  }
}
