// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/particles/seed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/map/statistics.hpp"
#include "common/stage/findings.hpp"

namespace talus::preprocess {
namespace {

constexpr double most = std::numeric_limits<int>::max();
constexpr double least_share = 0.1;  // of the volume of a point beside it

struct Counts {
  int x, y, z;
  std::size_t all() const {
    return static_cast<std::size_t>(x) * static_cast<std::size_t>(y) * static_cast<std::size_t>(z);
  }
};

Counts counts_for(double thickness, const Seeding& s) {
  const double layers = std::round(thickness / s.layer_height * s.in_height);
  return {s.along_x, s.along_y, static_cast<int>(std::clamp(layers, 1.0, most))};
}

struct Column {
  double west, south, side;  // of the cell [m]
  double foot, thickness;    // above the bed [m]
  int release;
};

void seed_column(const Column& column, const Seeding& s, Shift& shift, SeedPoints& points) {
  const Counts n = counts_for(column.thickness, s);
  const double volume = column.thickness * column.side * column.side / static_cast<double>(n.all());
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        points.x.push_back(column.west + (i + 0.5 + shift()) * column.side / n.x);
        points.y.push_back(column.south + (j + 0.5 + shift()) * column.side / n.y);
        points.height.push_back(column.foot + (k + 0.5 + shift()) * column.thickness / n.z);
        points.volume.push_back(volume);
        points.extent_x.push_back(column.side / n.x);
        points.extent_y.push_back(column.side / n.y);
        points.release.push_back(column.release);
      }
    }
  }
}

double volume_of_point(double thickness, double cell, const Seeding& s) {
  return thickness * cell * cell / static_cast<double>(counts_for(thickness, s).all());
}

/// The thickness of which columns are made: a cell whose points would be slivers beside those of its thickest neighbour
/// gives all that it has to its thicker neighbours, in proportion to their thickness. Mirror images are seeded alike.
Raster without_slivers(const Raster& thickness, const Seeding& s) {
  const double cell = thickness.grid.cell;
  std::vector<std::size_t> covered;
  for (std::size_t i = 0; i < thickness.values.size(); ++i)
    if (thickness.values[i] > 0) covered.push_back(i);
  std::ranges::stable_sort(covered, [&](auto a, auto b) { return thickness.values[a] < thickness.values[b]; });
  Raster columns = thickness;
  for (const std::size_t place : covered) {  // the thinnest first: what they give may be given on
    const double own = thickness.values[place];
    double thickest = own, sum = 0;
    const auto each_thicker = [&](const auto& visit) {
      each_near(thickness.grid, thickness.grid.cell_of(place), 1, [&](int column, int row) {
        const std::size_t other = thickness.grid.index(column, row);
        if (thickness.values[other] > own) visit(other, thickness.values[other]);
      });
    };
    each_thicker([&](std::size_t, double t) {
      thickest = std::max(thickest, t);
      sum += t;
    });
    if (volume_of_point(own, cell, s) >= least_share * volume_of_point(thickest, cell, s)) continue;
    const double given = std::exchange(columns.values[place], 0);
    each_thicker([&](std::size_t other, double t) { columns.values[other] += given * t / sum; });
  }
  return columns;
}

std::vector<Raster> without_slivers(const std::vector<Release>& releases, const Seeding& s) {
  std::vector<Raster> columns;
  for (const Release& release : releases) columns.push_back(without_slivers(release.thickness, s));
  return columns;
}

double count_of(const std::vector<Raster>& columns, const Seeding& s) {
  double count = 0;  // exact up to 2^53, and beyond all that can be counted before it overflows
  for (const Raster& thickness : columns) {
    for (const double t : thickness.values) {
      if (!(t > 0)) continue;
      const Counts n = counts_for(t, s);
      count += static_cast<double>(n.x) * n.y * n.z;
    }
  }
  return std::min(count, 1e18);
}

void reserve(SeedPoints& points, std::size_t count) {
  for (auto* values : {&points.x, &points.y, &points.height, &points.volume, &points.extent_x, &points.extent_y})
    values->reserve(count);
  points.release.reserve(count);
}

constexpr double enough_across = 8, enough_layers = 2;

/// Sides of released cells beside cells without release.
std::size_t sides_of(const Raster& thickness) {
  const MapGrid& grid = thickness.grid;
  const auto released = [&](int column, int row) { return grid.holds(column, row) && thickness.at(column, row) > 0; };
  std::size_t sides = 0;
  each_cell(grid, [&](int column, int row) {
    if (!released(column, row)) return;
    sides += !released(column - 1, row);
    sides += !released(column + 1, row);
    sides += !released(column, row - 1);
    sides += !released(column, row + 1);
  });
  return sides;
}

/// Two digits, not more than the number.
double round_down(double value) {
  const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1);
  return std::floor(value / digit + 1e-9) * digit;
}

/// How a release lies in its grid.
struct Fineness {
  double width = 0;   ///< four times its area over its outline: the side of a square, 0.8 of a disc's diameter [m]
  double median = 0;  ///< thickness, median by volume [m]
  double across = 0;  ///< cells across that width
  double layers = 0;  ///< layers over that thickness
};

/// That of a release of `thickness` [m] on layers of `layer_height` [m]; zeros without release.
Fineness fineness_of(const Raster& thickness, double layer_height) {
  const auto cells = static_cast<double>(std::ranges::count_if(thickness.values, [](double t) { return t > 0; }));
  if (!(cells > 0)) return {};
  Fineness f;
  f.across = 4 * cells / static_cast<double>(sides_of(thickness));
  f.width = f.across * thickness.grid.cell;
  f.median = median_thickness(thickness);
  f.layers = f.median / layer_height;
  return f;
}

}  // namespace

double default_layer_height(const Raster& thickness, double spacing) {
  const double half = 0.5 * median_thickness(thickness);
  if (!(half > 0)) return spacing;
  return std::min(spacing, round_down(half));
}

Seeding seeding_of(const GridOptions& options, double layer_height) {
  const auto& n = options.points_per_cell;
  return {n.at(0), n.at(1), n.at(2), layer_height, options.jitter};
}

std::size_t count_points(const std::vector<Release>& releases, const Seeding& seeding) {
  return static_cast<std::size_t>(count_of(without_slivers(releases, seeding), seeding));
}

SeedPoints seed_points(const std::vector<Release>& releases, const Seeding& seeding) {
  SeedPoints points;
  if (releases.empty()) return points;
  const std::vector<Raster> columns = without_slivers(releases, seeding);
  reserve(points, static_cast<std::size_t>(count_of(columns, seeding)));
  const MapGrid& grid = columns.front().grid;
  Shift shift(seeding.jitter);
  each_cell(grid, [&](int column, int row) {
    double foot = 0;
    for (std::size_t r = 0; r < columns.size(); ++r) {
      const double t = columns[r].at(column, row);
      if (!(t > 0)) continue;
      seed_column(
          {grid.west + column * grid.cell, grid.south + row * grid.cell, grid.cell, foot, t, static_cast<int>(r)},
          seeding, shift, points);
      foot += t;
    }
  });
  return points;
}

void warn_of_coarseness(const Raster& thickness, double layer_height, std::size_t points, const GridOptions& grid) {
  const Fineness f = fineness_of(thickness, layer_height);
  const bool few_layers = grid.layer_height > 0 && f.layers < enough_layers;
  if (!(f.across > 0) || (f.across >= enough_across && !few_layers)) return;
  const double cell = thickness.grid.cell,
               spacing = f.across < enough_across ? round_down(f.width / enough_across) : cell,
               layer = std::min({round_down(f.median / enough_layers), spacing, layer_height});
  Sum volume;
  for (const double t : thickness.values) volume.add(t > 0 ? t : 0);
  double wanted = volume.value() * cell * cell / (spacing * spacing * layer);
  for (const int n : grid.points_per_cell) wanted *= n;
  std::vector<std::string> keys;  // those that change
  if (spacing < cell) keys.push_back(fmt::format("spacing_m = {:g}", spacing));
  if (layer < layer_height || keys.empty() || grid.layer_height > 0)
    keys.push_back(fmt::format("layer_height_m = {:g}", layer));
  warn("coarse-grid",
       fmt::format(
           "the grid is coarse for this release: about {:.3g} m wide, it has {:.2g} cells of {:g} m across, and over "
           "its "
           "thickness of {:.2g} m (median by volume) {:.2g} layers of {:g} m; {} material points are all of it. "
           "Run-out and "
           "thickness depend on the cells then. For {:g} cells and {:g} layers put {} into [preprocess.grid] (some {} "
           "points)",
           f.width, f.across, cell, f.median, f.layers, layer_height, grouped(static_cast<double>(points)),
           enough_across, enough_layers, fmt::join(keys, " and "), grouped(wanted)),
       {{"cells_across", f.across, "1"}, {"layers", f.layers, "1"}});
}

}  // namespace talus::preprocess
