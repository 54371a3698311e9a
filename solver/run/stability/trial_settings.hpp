// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How the trials of a search for the factor of safety are computed.
#pragma once

#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/settings.hpp"

namespace talus::solver {

/// The settings of one step that brings gravity on, from time 0 to 1, with the strength divided by `factor`.
SolverSettings static_settings(const SolveOptions& options, const Scene& scene, double factor);

/// The same for backward Euler steps of this length [s], with all gravity there.
SolverSettings falling_settings(const SolveOptions& options, const Scene& scene, double factor, double step);

/// Whether the ground is so narrow, as a strip in plane strain is, that factorising its tangent takes less time than
/// conjugate gradients: few nodes in a section across its longest side.
bool narrow(const ParticleState& points);

}  // namespace talus::solver
