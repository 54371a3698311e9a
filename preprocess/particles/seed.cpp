// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/particles/seed.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/map/statistics.hpp"
#include "preprocess/particles/shift.hpp"

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
/// gives all that it has to its thicker neighbours, in proportion to their thickness. So a mirrored release is seeded
/// as the mirror image.
Raster without_slivers(const Raster& thickness, const Seeding& s) {
  const double cell = thickness.grid.cell;
  std::vector<std::size_t> covered;
  for (std::size_t i = 0; i < thickness.values.size(); ++i)
    if (thickness.values[i] > 0) covered.push_back(i);
  std::stable_sort(covered.begin(), covered.end(),
                   [&](auto a, auto b) { return thickness.values[a] < thickness.values[b]; });
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

}  // namespace

double default_layer_height(const Raster& thickness, double spacing) {
  const double half = 0.5 * median_thickness(thickness);
  if (!(half > 0)) return spacing;
  const double last_digit = std::pow(10.0, std::floor(std::log10(half)) - 1);
  return std::min(spacing, std::floor(half / last_digit + 1e-9) * last_digit);
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
  for (int row = 0; row < grid.rows; ++row) {
    for (int column = 0; column < grid.columns; ++column) {
      double foot = 0;
      for (std::size_t r = 0; r < columns.size(); ++r) {
        const double t = columns[r].at(column, row);
        if (!(t > 0)) continue;
        seed_column(
            {grid.west + column * grid.cell, grid.south + row * grid.cell, grid.cell, foot, t, static_cast<int>(r)},
            seeding, shift, points);
        foot += t;
      }
    }
  }
  return points;
}

}  // namespace talus::preprocess
