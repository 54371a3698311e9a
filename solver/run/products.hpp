// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run leaves behind: maps of its end, the volumes of the slide, and whether its numbers are sane.
#pragma once

#include <functional>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/findings.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

/// The initial volume of the points whose index `counts` accepts, over the area of each map cell, spread as the grid's
/// functions spread it [m]; [rows * columns].
std::vector<double> thickness_of(const Scene& scene, const SolveOptions& options, const ParticleState& points,
                                 const std::function<bool(std::size_t)>& counts);

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

/// Bounds of what is sane; beyond them a run says so. The reasons stand in docs/notes/plausibility.md.
struct SanityBounds {
  double volume_error = 1e-6;  ///< volumes in single precision are exact to 6e-8
  double volume_left = 0.5;    ///< beyond it the map shows less than half of the slide
  double packing_p99 = 4;      ///< a quarter above the worst of the samples and real events
  double energy_gain = 0.02;   ///< of what was turned over
  double speed_share = 1.05;   ///< of the speed of a fall without loss
};

/// Measures a run at its end from its history, maps and points at the start. `outflow` is what left the domain [m3].
RunSanity sanity_of(const RunEnd& end, const RunHistory& history, double outflow);

/// Warnings of what is beyond its bound; none where nothing is.
std::vector<Finding> insane(const RunSanity& sanity, const SanityBounds& bounds = {});

/// Logs one line with all numbers, and adds the warnings.
void say_sanity(const RunSanity& sanity);

}  // namespace talus::solver
