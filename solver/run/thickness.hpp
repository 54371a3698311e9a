// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Thickness over the map of some of the points, on the host: the maps of the end of a run.
#pragma once

#include <functional>
#include <vector>

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

/// The initial volume of the points whose index `counts` accepts, over the area of each map cell, spread as the grid's
/// functions spread it [m]; [rows * columns].
std::vector<double> thickness_of(const Scene& scene, const SolveOptions& options, const ParticleState& points,
                                 const std::function<bool(std::size_t)>& counts);

}  // namespace talus::solver
