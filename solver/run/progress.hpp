// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The progress line of a run, and the error that names a point which lost its state.
#pragma once

#include <string>

#include "solver/integrator/scene.hpp"
#include "solver/state/clock.hpp"

namespace talus::solver {

/// How far a run has come.
struct RunProgress {
  double end_time;    ///< [s]
  double mass_error;  ///< volume in the domain and out of it over volume released, less one [-]
  double wall_time;   ///< since the start [s]
};

/// One line: time, step, step size, largest speed, error of mass, wall time still to come.
std::string progress_line(const Clock& clock, const RunProgress& progress);

/// This function throws the NumericalError that names the point whose state is not a number, or which is faster than
/// 1000 km/s, where it is, and the way out. `cfl`: the recipe's cfl.
[[noreturn]] void refuse_lost_point(const Clock& clock, const ParticleState& points, const MapGrid& map, double cfl);

}  // namespace talus::solver
