// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces by triangulation: through scattered points, read off on a grid, and over one hole in a raster, from its
// rim. CGAL stays behind triangulation.cpp.
#pragma once

#include <array>
#include <filesystem>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/terrain/geo_input.hpp"

namespace talus::preprocess {

using Cell = std::array<int, 2>;  // column, row

/// Rings of cells around a hole that take part (a second ring would be hidden behind the first), and how far around
/// each of them its gradient is taken from [cells].
constexpr int rim_width = 1, gradient_reach = 3;

/// The surface that bridges a hole: natural neighbours (Sibson 1981), without or with gradients of the cells around.
enum class HoleSurface { sibson, quadratic };

/// Elevations for `wanted`, a part of the `hole`, from the cells around the hole that have one. The hole's own values
/// are not looked at. Every cell of the hole must be at least one cell from the raster's edge.
std::vector<double> fill_hole(const Raster& raster, const std::vector<Cell>& hole, const std::vector<Cell>& wanted,
                              HoleSurface how = HoleSurface::quadratic);

/// Delaunay triangulation of the points, interpolated linearly at the cell centres of `grid` (same CRS); NaN outside
/// their convex hull. Points at one place are averaged. Throws DataError (naming `file`): all lie on a line.
Raster interpolate_scattered(const ScatteredPoints& points, const MapGrid& grid, const std::filesystem::path& file);

/// Warnings of points that leave out ground, or contradict one another: "gaps-between-points" (more than a hundredth of
/// the triangulated ground lies in triangles with a side longer than six times the median one, by area), and
/// "points-at-one-place" (their elevations differ by more than 0.1 m).
void warn_of_points(const ScatteredPoints& points, const std::filesystem::path& file);

}  // namespace talus::preprocess
