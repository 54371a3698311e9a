// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Outlines on the map: those of all members that are kept, thin, and the chosen one's, bold.

export const mostDrawn = 300; // thin outlines; more are a blot

export const styles = {
  spaghetti: { colour: "#1f1f24", width: 0.7, opacity: 0.35 },
  flow: { colour: "#d55e00", width: 2.6, casing: 5 },
  deposit: { colour: "#0072b2", width: 2.2, dashes: [6, 4], casing: 4.4 },
  release: { colour: "#00735c", width: 2.2, casing: 4 },
  survey: { colour: "#004db3", width: 2, dashes: [9, 5], casing: 4 },
};

/** Every so many of a list, so that no more than `most` are left. */
function thinned(list, most) {
  const step = Math.max(1, list.length / most);
  return Array.from({ length: Math.min(list.length, most) }, (_, i) => list[Math.floor(i * step)]);
}

export class Outlines {
  constructor(outlines, leaflet) {
    Object.assign(this, { outlines, leaflet });
    this.place = new Map(outlines.members.map((member, i) => [member, i]));
    this.renderer = L.canvas({ padding: 0.3 });
    this.thin = L.layerGroup().addTo(leaflet);
    this.bold = L.layerGroup().addTo(leaflet);
    this.shown = { spaghetti: true, deposit: true };
    this.drawn = 0;
  }

  has(member) {
    return this.place.has(member);
  }

  /** Half cells to [north, east]. */
  lines(flat) {
    const { west, south, half_cell: half } = this.outlines;
    return flat.map((line) => {
      const points = [];
      for (let i = 0; i < line.length; i += 2) points.push([south + line[i + 1] * half, west + line[i] * half]);
      return points;
    });
  }

  add(group, lines, style) {
    const options = { renderer: this.renderer, interactive: false, smoothFactor: 0.5 };
    if (style.casing)
      group.addLayer(L.polyline(lines, { ...options, color: "#fff", weight: style.casing, opacity: 0.85 }));
    group.addLayer(
      L.polyline(lines, {
        ...options,
        color: style.colour,
        weight: style.width,
        opacity: style.opacity ?? 1,
        dashArray: (style.dashes ?? []).join(" ") || null,
      }),
    );
  }

  /** Draws what the selection asks for. */
  draw(selection) {
    this.thin.clearLayers();
    this.bold.clearLayers();
    const kept = this.outlines.members.filter((member) => selection.keeps(member));
    const some = this.shown.spaghetti ? thinned(kept, mostDrawn) : [];
    this.drawn = some.length;
    for (const member of some)
      this.add(this.thin, this.lines(this.outlines.flow[this.place.get(member)]), styles.spaghetti);
    const chosen = this.place.get(selection.chosen);
    if (chosen === undefined) return;
    this.add(this.bold, this.lines(this.outlines.flow[chosen]), styles.flow);
    if (this.shown.deposit) this.add(this.bold, this.lines(this.outlines.deposit[chosen]), styles.deposit);
  }
}
