// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run leaves behind: maps of its end and the volumes of the slide.
#pragma once

#include <vector>

#include "common/domain/domain.hpp"
#include "common/run/run_file.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// A run at its end.
struct RunEnd {
  const Domain& domain;
  const SolveOptions& options;
  const Scene& scene;
  const SolverState& state;
  const std::vector<double>& initial_thickness;  ///< of all points [m]
  std::int64_t pulses = 0;                       ///< of the inflows that have entered
};

/// The volumes of the slide [m3].
struct SlideVolumes {
  double released = 0;
  double entrained = 0;  ///< eroded from the ground on the way
  double final = 0;      ///< still in the domain
};

/// Whether point `p` of the end belongs to the slide: released, or taken along from the ground by more than a cell.
bool belongs_to_slide(const RunEnd& end, std::size_t p);

/// The volumes of the slide; `outflow` is what left the domain [m3].
SlideVolumes slide_volumes(const RunEnd& end, double outflow);

/// The maps of run.h5, [rows * columns] each; `thickness` is that of all points at the end [m]. With several releases
/// there is a map of each, and what still lies in the ground counts as ground.
RunMaps final_maps(const RunEnd& end, std::vector<double> thickness);

}  // namespace talus::solver
