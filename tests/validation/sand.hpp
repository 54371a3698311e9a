// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sand columns of A3, A3b and C1: grid, box and walls of a recipe for any size of cell, and what they leave behind.
#pragma once

#include "tests/validation/cases.hpp"
#include "tests/validation/chart.hpp"
#include "tests/validation/closed_forms.hpp"

namespace talus::validation {

inline constexpr double gate_opens = 0.3;  // [s]

struct Sand {
  double h = 0.01;   // cells [m]
  int per_cell = 4;  // points along each side of a cell
  double height = 0.63, width = 0.09;
  double flow_time = 1.2;  // after the gate [s]
  double point_spacing() const { return h / per_cell; }
};

inline Overrides overrides_of(const Sand& s) {
  // Room for half as much again as Lube's law says.
  const double aspect = s.height / s.width, law = lube_run_out(aspect);
  const double reach = s.width * (1 + 1.5 * (std::isfinite(law) ? law : 1.6 * aspect));
  return grid_of(s.h, s.per_cell) + Overrides{{"preprocess.laboratory.cells[0]", whole(std::lround(reach / s.h) + 8)},
                                              {"preprocess.box[0].extent_m[2]", s.width},
                                              {"preprocess.box[0].extent_m[3]", s.h},
                                              {"preprocess.box[0].extent_m[5]", s.height},
                                              {"solve.wall[1].position_m", s.width},
                                              {"solve.wall[4].position_m", s.h},
                                              {"solve.end_time_s", gate_opens + s.flow_time}};
}

inline double front_of(const Points& points, const Sand& s) {
  return front_of(points, s.h, [&](double) { return s.h; });
}

/// The height of the highest point and half a point more [m].
double top_of(const Points& points, const Sand& s);

/// Run-out and height of a deposit over the width of the column; NaN where there is no result.
inline double run_out_of(const Outcome& o, const Sand& s) {
  return o.ok() ? front_of(o.last(), s) / s.width - 1 : nothing;
}
inline double height_of(const Outcome& o, const Sand& s) { return o.ok() ? top_of(o.last(), s) / s.width : nothing; }

/// Thickness over x from the map of a frame, all rows of the slice together, folded back at the wall at x = 0; the mean
/// of three columns, for the strings of points of a stretched lattice lie further apart than a cell.
Series outline_of(const Outcome& o, std::size_t frame, const Sand& s, int colour);

/// The same over the distance from the axis, of a quarter of a round deposit: the mean of rings two cells wide.
Series outline_of_quarter(const Points& points, const Sand& s, int colour);

/// A quarter of a round column from strips of a sixteenth of its radius along y, each as far along x as the circle,
/// rounded to a sixteenth as well.
Overrides round_column(const Sand& s);

/// Height and run-out of a laboratory as two marks.
Series laboratory(const std::string& name, const Sand& s, double run_out, double height, int colour);
/// Those of both laboratories that measured in channels.
std::vector<Series> channel_laboratories(const std::string& first_name, const Sand& s);

/// The root mean square difference of two outlines over the length of the longer one, over the height of the finer.
double profile_difference(const Series& coarse, const Series& fine);

struct Collapse {
  Outcome outcome;
  double front = nothing, top = nothing;
};

/// A run whose run-out and height are judged by the band of both laboratories.
Collapse collapse(Bench& bench, const std::string& name, const Sand& s, const Overrides& more);

}  // namespace talus::validation
