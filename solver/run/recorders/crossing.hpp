// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Geometry of sections: which way a path crosses a line, and how far a place lies from it.
#pragma once

#include <array>

namespace talus::solver {

/// Twice the signed area of the triangle a, b, c: positive where c lies to the left of the way from a to b.
double turn(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c);

/// What the points of a line are shifted by before paths are held against it [cells]: points of a run lie on lattices,
/// lines at round coordinates, and where a corner of the one lies on the other a crossing is nobody's. So small a shift
/// moves no result, and no lattice of cells, nor of single precision about one, comes to lie on the line by it.
inline constexpr std::array<double, 2> off_lattice{0.7310585786e-9, 0.3678794412e-9};

/// How the straight path from `from` to `to` crosses the piece of a line from `a` to `b`: 1 from its left to its right,
/// -1 the other way, 0 not at all. Pieces that share an end, and paths that do, count a crossing once.
int crossing(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& from,
             const std::array<double, 2>& to);

/// The distance of a place from the piece of a line.
double distance(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& place);

}  // namespace talus::solver
