// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sand columns of A3, A3b and C1: grid, box and walls of a recipe for any size of cell.
#pragma once

#include <cmath>

#include "tests/validation/closed_forms.hpp"
#include "tests/validation/points.hpp"
#include "tests/validation/recipe_text.hpp"

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
  return {{"preprocess.grid.spacing_m", s.h},
          {"preprocess.grid.points_per_cell", std::vector<std::int64_t>(3, s.per_cell)},
          {"preprocess.laboratory.cells[0]", whole(std::lround(reach / s.h) + 8)},
          {"preprocess.laboratory.corner_m[0]", -3.5 * s.h},
          {"preprocess.laboratory.corner_m[1]", -3.5 * s.h},
          {"preprocess.box[0].extent_m[2]", s.width},
          {"preprocess.box[0].extent_m[3]", s.h},
          {"preprocess.box[0].extent_m[5]", s.height},
          {"solve.wall[1].position_m", s.width},
          {"solve.wall[4].position_m", s.h},
          {"solve.end_time_s", gate_opens + s.flow_time}};
}

inline double front_of(const Points& points, const Sand& s) { return front_of(points, s.h, s.point_spacing()); }

}  // namespace talus::validation
