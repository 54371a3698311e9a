// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/laboratory/laboratory.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/gis/resampling.hpp"
#include "preprocess/options/laboratory.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/terrain/working_grid.hpp"

namespace talus::preprocess {
namespace {

constexpr double rounding = 1e-6;  // of a cell: what a length written in decimals may be off by

/// Points along x, y and height.
std::array<long, 3> lattice_of(const BoxOptions& box, const GridOptions& grid) {
  const auto sides = sides_of(box);
  const auto spacing = point_spacing(grid);
  std::array<long, 3> counts{};
  for (std::size_t a = 0; a < 3; ++a) counts[a] = std::lround(std::min(sides[a].length() / spacing[a], 1e18));
  return counts;
}

/// Part of the cell [low, low + size] that [from, to] covers.
double covered(double low, double size, double from, double to) {
  const double length = std::min(low + size, to) - std::max(low, from);
  return length > rounding * size ? std::min(length / size, 1.0) : 0.0;
}

/// The boxes with level tops that a box consists of: itself, or one for each column of its lattice of points, as high
/// as the points whose places lie under its top.
std::vector<BoxOptions> pieces_of(const BoxOptions& box, const GridOptions& grid) {
  if (!box.top_east) return {box};
  const auto n = lattice_of(box, grid);
  const auto side = sides_of(box);
  const double width = side[0].length() / static_cast<double>(n[0]),
               height = side[2].length() / static_cast<double>(n[2]);
  std::vector<BoxOptions> pieces;
  for (long i = 0; i < n[0]; ++i) {
    BoxOptions piece = box;
    piece.top_east.reset();
    piece.west = box.west + static_cast<double>(i) * width;
    piece.east = box.west + static_cast<double>(i + 1) * width;
    const double under = box.top_at(0.5 * (piece.west + piece.east)) - box.bottom;
    const double points = std::round(under / height * (1 - rounding));
    if (points < 1) continue;
    piece.top = box.bottom + points * height;
    pieces.push_back(piece);
  }
  return pieces;
}

/// All boxes as such pieces, with the index of the box that each belongs to.
std::vector<std::pair<BoxOptions, std::size_t>> all_pieces(const Options& options) {
  std::vector<std::pair<BoxOptions, std::size_t>> pieces;
  for (std::size_t b = 0; b < options.box.size(); ++b)
    for (BoxOptions& piece : pieces_of(options.box[b], options.grid)) pieces.emplace_back(std::move(piece), b);
  return pieces;
}

Raster cover_of(const MapGrid& grid, const BoxOptions& box) {
  Raster cover{grid, std::vector<double>(grid.count(), 0.0)};
  for (int row = 0; row < grid.rows; ++row) {
    const double in_row = covered(grid.south + row * grid.cell, grid.cell, box.south, box.north);
    for (int column = 0; in_row > 0 && column < grid.columns; ++column)
      cover.at(column, row) = in_row * covered(grid.west + column * grid.cell, grid.cell, box.west, box.east);
  }
  return cover;
}

}  // namespace

Raster laboratory_ground(const Options& options) {
  const LaboratoryOptions& lab = options.laboratory;
  const MapGrid grid = laboratory_grid(options);
  require_told_apart(grid, "[preprocess.laboratory]");
  require_room(grid.columns, grid.rows, bytes_per_cell(options), "[preprocess.laboratory]",
               "Give fewer columns or rows");
  Raster ground{grid, std::vector<double>(grid.count())};
  each_cell(grid, [&](int column, int row) {
    ground.at(column, row) =
        lab.ground + lab.slope_x * (grid.x(column) - grid.west) + lab.slope_y * (grid.y(row) - grid.south);
  });
  return ground;
}

Release box_release(const Options& options, std::size_t item) {
  const BoxOptions& box = options.box.at(item);
  const MapGrid grid = laboratory_grid(options);
  Raster thickness{grid, std::vector<double>(grid.count(), 0.0)};
  for (const BoxOptions& piece : pieces_of(box, options.grid)) {
    const Raster cover = cover_of(grid, piece);
    for (std::size_t i = 0; i < cover.values.size(); ++i)
      thickness.values[i] += cover.values[i] * (piece.top - piece.bottom);
  }
  return {box_name(box, item), std::move(thickness)};
}

Raster box_surface(const Options& options, const Raster& ground) {
  std::vector<double> height(ground.values.size(), 0.0);
  for (const BoxOptions& box : options.box) {
    Raster own{ground.grid, std::vector<double>(height.size(), 0.0)};
    for (const BoxOptions& piece : pieces_of(box, options.grid)) {
      const Raster cover = cover_of(ground.grid, piece);
      for (std::size_t i = 0; i < height.size(); ++i) own.values[i] += cover.values[i] * piece.top;
    }
    for (std::size_t i = 0; i < height.size(); ++i) height[i] = std::max(height[i], own.values[i]);
  }
  Raster surface = ground;
  for (std::size_t i = 0; i < height.size(); ++i) surface.values[i] += height[i];
  return surface;
}

std::size_t count_box_points(const Options& options) {
  double count = 0;  // beyond all that can be counted before it overflows
  for (const auto& [box, item] : all_pieces(options)) {
    const auto n = lattice_of(box, options.grid);
    count += static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
  }
  return static_cast<std::size_t>(std::min(count, 1e18));
}

SeedPoints seed_boxes(const Options& options) {
  SeedPoints points;
  Shift shift(options.grid.jitter);
  for (const auto& [box, item] : all_pieces(options)) {
    const auto n = lattice_of(box, options.grid);
    const auto side = sides_of(box);
    const auto place = [&](std::size_t axis, long step) {
      return side[axis].low +
             (static_cast<double>(step) + 0.5 + shift()) * side[axis].length() / static_cast<double>(n[axis]);
    };
    const double count = static_cast<double>(n[0]) * static_cast<double>(n[1]) * static_cast<double>(n[2]);
    const double volume = side[0].length() * side[1].length() * side[2].length() / count;
    for (long k = 0; k < n[2]; ++k) {
      for (long j = 0; j < n[1]; ++j) {
        for (long i = 0; i < n[0]; ++i) {
          points.x.push_back(place(0, i));
          points.y.push_back(place(1, j));
          points.height.push_back(place(2, k));
          points.volume.push_back(volume);
          points.extent_x.push_back(side[0].length() / static_cast<double>(n[0]));
          points.extent_y.push_back(side[1].length() / static_cast<double>(n[1]));
          points.release.push_back(static_cast<int>(item));
        }
      }
    }
  }
  return points;
}

}  // namespace talus::preprocess
