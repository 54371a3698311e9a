// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// D1 to D5: factors of safety by strength reduction against published ones.
#include <fmt/format.h>

#include <algorithm>

#include "tests/validation/cases.hpp"
#include "tests/validation/map_scene.hpp"
#include "tests/validation/slices.hpp"

namespace talus::validation {
namespace {

/// A number that a search has left in run.h5; NaN where there is none.
double found(const Outcome& o, const std::string& name) {
  if (!o.ok()) return nothing;
  const auto& facts = o.run.summary.provenance;
  const auto fact = std::ranges::find(facts, "stability." + name, [](const auto& f) { return f.first; });
  return fact == facts.end() ? nothing : std::stod(fact->second);
}

double factor_of(const Outcome& o) { return found(o, "factor_of_safety"); }

void note_effort(Bench& bench, const Outcome& o) {
  bench.note(o, "trials", found(o, "trials"));
  bench.note(o, "time [s]", o.ok() ? o.run.summary.wall_time : nothing);
}

/// The strip of a recipe with this length [m] and number of boxes in cells of this width [m].
Overrides in_cells(double h, double length, int boxes) {
  Overrides changes{{"preprocess.grid.spacing_m", h},
                    {"preprocess.laboratory.cells[0]", whole(std::lround(length / h) + 8)},
                    {"preprocess.laboratory.corner_m[0]", -3.5 * h},
                    {"preprocess.laboratory.corner_m[1]", -2.5 * h},
                    {"solve.wall[2].position_m", h}};
  for (int n = 0; n < boxes; ++n) changes.push_back({fmt::format("preprocess.box[{}].extent_m[3]", n), h});
  return changes;
}

}  // namespace

void homogeneous_slope(Bench& bench) {
  // Griffiths & Lane 1999: 1.4 by finite elements; Bishop & Morgenstern 1960: 1.380 by slices.
  constexpr double chart = 1.380, elements = 1.4;
  const double h = bench.coarse() ? 1 : 0.5, tolerance = bench.coarse() ? 0.03 : 0.02;
  const Outcome dry = bench.run(fmt::format("dry, {:g} cells over the height", 10 / h), in_cells(h, 32, 2));
  bench.compare(dry, "factor against the charts of Bishop & Morgenstern", factor_of(dry), chart, tolerance);
  bench.compare(dry, "factor against Griffiths & Lane's elements", factor_of(dry), elements, tolerance);
  note_effort(bench, dry);
  if (bench.coarse()) return;
  // The recipe's ratio is of the mean stress, r_u of the weight above: where the ground yields the two come close.
  constexpr double ratio = 0.25;
  const double slices = bishop_factor({.cohesion = 0.05, .friction = 20, .water = ratio});
  const Outcome wet = bench.run(fmt::format("r_u = {:g}", ratio), {{"solve.material.pore_pressure_ratio", ratio}});
  bench.compare(wet, "factor against slices with r_u", factor_of(wet), slices, tolerance);
  note_effort(bench, wet);
}

void undrained_cut(Bench& bench) {
  // Martin 2011: rho g H / c = 3.7765 as slip lines and adaptive limit analysis have it.
  const double exact = 3.7765 * 50000 / (2000 * 9.81 * 10);
  for (const auto& [h, tolerance] : {std::pair{1.0, 0.05}, {0.5, 0.02}}) {
    const Outcome o = bench.run(fmt::format("{:g} cells over the height", 10 / h), in_cells(h, 20, 1));
    bench.compare(o, "factor", factor_of(o), exact, tolerance);
    note_effort(bench, o);
    if (bench.coarse()) return;
  }
}

void slope_on_foundation(Bench& bench) {
  // Griffiths & Lane 1999 read 1.4 "unchanged"; circles that are not held to the toe have 1.37.
  const Outcome o = bench.run("foundation, 20 cells over the height", {});
  const double slices = bishop_factor({.cohesion = 0.05, .friction = 20, .base = 1.5});
  bench.compare(o, "factor against slices", factor_of(o), slices, 0.02);
  bench.compare(o, "factor against Griffiths & Lane's elements", factor_of(o), 1.4, 0.03);
  note_effort(bench, o);
}

void slope_on_seam(Bench& bench) {
  // The referees of the survey (Giam & Donald 1989) give 1.24 to 1.27.
  const Outcome o = bench.run("seam of one cell", {});
  bench.within(o, "factor", factor_of(o), {1.24, 1.27}, 0.02);
  note_effort(bench, o);
}

void rock_wedge(Bench& bench) {
  constexpr double length = 8, half_width = 8, thickness = 2;  // in plan, vertical [m]
  const double slope = std::tan(30 * degree), side = std::tan(30 * degree);
  const MapGrid grid{.columns = 20, .rows = 24, .west = 0, .south = -12, .cell = 1, .crs_wkt = ""};
  const auto ground = [&](double x, double y) { return 100 - slope * x + side * std::abs(y); };
  const auto slab = [&](double x, double y) {
    return x > 4 && x < 4 + length && std::abs(y) < half_width ? thickness : 0.0;
  };
  const Outcome o =
      bench.run("two planes", write_scene(bench, "wedge", cell_means(grid, ground), cell_means(grid, slab)));
  // Hoek & Bray 1981, friction alone: sin(beta) / sin(xi / 2) tan(phi) / tan(psi_i), of two planes alike.
  const double wedging = std::sqrt(1 + side * side / (1 + slope * slope));
  bench.compare(o, "factor of the wedge", factor_of(o), wedging * std::tan(25 * degree) / slope, 0.02);
  note_effort(bench, o);
}

}  // namespace talus::validation
