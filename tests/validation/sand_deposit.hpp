// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a column of sand leaves behind: how far and how high it lies, and its profile.
#pragma once

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/sand_scene.hpp"

namespace talus::validation {

/// The height of the highest point and half a point more [m].
double top_of(const Points& points, const Sand& s);

/// Thickness over x from the map of a frame, all rows of the slice together. What the functions spread behind the wall
/// at x = 0 is folded back; the mean of three columns, for the strings of points of a stretched lattice lie further
/// apart than a cell.
Series outline_of(const Outcome& o, std::size_t frame, const Sand& s, int colour);

/// The same over the distance from the axis, of a quarter of a round deposit: the mean of rings two cells wide.
Series outline_of_quarter(const Points& points, const Sand& s, int colour);

/// Height and run-out of a laboratory as two marks.
Series laboratory(const std::string& name, const Sand& s, double run_out, double height, int colour);

/// The root mean square difference of two outlines over the length of the longer one, over the height of the finer.
double profile_difference(const Series& coarse, const Series& fine);

struct Collapse {
  Outcome outcome;
  double front = nothing, top = nothing;
};

/// A run whose run-out and height are judged by the band of both laboratories.
Collapse collapse(Bench& bench, const std::string& name, const Sand& s, const Overrides& more);

}  // namespace talus::validation
