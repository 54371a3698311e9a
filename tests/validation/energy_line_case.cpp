// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// B3: a heap of sand on curved ground, whatever way that faces.
#include <fmt/format.h>

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/closed_forms.hpp"
#include "tests/validation/map_scene.hpp"

namespace talus::validation {
namespace {

struct Terrain {
  const char* name;
  GroundLine line;
};

/// Fall 1000 m over 2250 m, then level: as a parabola, or at 30 degrees until an arc of 400 m leads over.
constexpr Terrain terrains[] = {{"parabola", {GroundLine::parabola, 1000, 2250, 0}},
                                {"hockey stick", {GroundLine::bend, 1000, 0, 400}}};

// The heap: its middle along the line and its sizes [m].
constexpr double first = 400, heap_length = 120, width = 100, thickness = 10;
constexpr double mu = 0.4;

struct Facing {
  double angle;  // of descent, from east [deg]
  double along(double x, double y) const { return x * std::cos(angle * degree) + y * std::sin(angle * degree); }
  double across(double x, double y) const { return y * std::cos(angle * degree) - x * std::sin(angle * degree); }
};

/// Ground and heap beside the run. Returns what names them in the recipe.
Overrides lay_out(const Bench& bench, const Terrain& terrain, const Facing& facing, double cell) {
  double west = 1e30, east = -1e30, south = 1e30, north = -1e30;  // around the way, 300 m wide
  for (const double s : {100.0, 3300.0}) {
    for (const double t : {-300.0, 300.0}) {
      const double x = s * std::cos(facing.angle * degree) - t * std::sin(facing.angle * degree);
      const double y = s * std::sin(facing.angle * degree) + t * std::cos(facing.angle * degree);
      west = std::min(west, x), east = std::max(east, x), south = std::min(south, y), north = std::max(north, y);
    }
  }
  MapGrid grid;
  grid.cell = cell;
  grid.west = std::floor(west / cell) * cell;
  grid.south = std::floor(south / cell) * cell;
  grid.columns = static_cast<int>(std::ceil((east - grid.west) / cell));
  grid.rows = static_cast<int>(std::ceil((north - grid.south) / cell));
  const Raster ground =
      at_centres(grid, [&](double x, double y) { return terrain.line.elevation(facing.along(x, y)); });
  const Raster heap = cell_means(grid, [&](double x, double y) {
    return std::abs(facing.along(x, y) - first) < 0.5 * heap_length && std::abs(facing.across(x, y)) < 0.5 * width
               ? thickness
               : 0.0;
  });
  const char* line = terrain.line.kind == GroundLine::parabola ? "parabola" : "bend";
  return write_scene(bench, fmt::format("{}-{:g}-{:g}", line, facing.angle, cell), ground, heap);
}

/// Mean place of the points along the line and across it [m], and above the ground's own zero.
struct Place {
  double along = 0, across = 0, up = 0;
};
Place place_of(const Points& points, const Facing& facing) {
  const auto [x, y, z] = centre_of(points);
  return {facing.along(x, y), facing.across(x, y), z};
}

}  // namespace

void energy_line(Bench& bench) {
  Chart chart = plain_chart("B3: way of the centre over the direction of descent",
                            "direction of descent, from east [deg]", "way of the centre over that of a sliding point");
  int colour = 1;
  const std::vector<double> cells = bench.complete() ? std::vector<double>{20, 10}
                                    : bench.coarse() ? std::vector<double>{40}
                                                     : std::vector<double>{20};
  for (const Terrain& terrain : terrains) {
    for (const Way& how : ways) {
      if (!bench.complete() && (terrain.line.kind != GroundLine::parabola || &how != &ways[0])) continue;
      for (const double cell : cells) {
        Series line = marked_line(fmt::format("{}, {}, cells of {:g} m", terrain.name, how.name, cell), colour++);
        double eastwards = nothing;
        for (const double angle : {0.0, 120.0, 225.0}) {
          const Facing facing{angle};
          const Outcome o =
              bench.run(fmt::format("{}, {}, {:g} m, towards {:g} deg", terrain.name, how.name, cell, angle),
                        lay_out(bench, terrain, facing, cell) + overrides_of(how, cell, 0.25 * cell));
          double way = nothing, aside = nothing, fall = nothing, expected = terrain.line.reach(first, mu) - first;
          if (o.ok()) {
            const Place start = place_of(o.first(), facing), end = place_of(o.last(), facing);
            expected = terrain.line.reach(start.along, mu) - start.along;
            way = end.along - start.along;
            aside = end.across - start.across;
            fall = (start.up - end.up) / way;
          }
          if (angle == 0) eastwards = way;
          // validation.md B3: directions differ by less than 2 %; that of a point is met as well as the heap is one.
          bench.compare(o, "way of the centre", way, expected, 0.02);
          if (angle != 0) bench.compare(o, "way of the centre, against eastwards", way, eastwards, 0.02);
          bench.note(o, "fall over way", fall);
          bench.measure(o, "drift across, over the way", aside / way, 0.005);
          line.add(angle, way / expected);
        }
        chart.series.push_back(line);
      }
    }
  }
  chart.y = Limits{0.9, 1.1};
  bench.picture("B3-directions", png_of(chart));
}

}  // namespace talus::validation
