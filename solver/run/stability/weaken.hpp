// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Ground whose strength is divided by a factor (T40), as searches for the factor of safety try it.
#pragma once

#include <vector>

#include "common/domain/domain.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/settings.hpp"

namespace talus::solver {

/// The weight of the deepest column over the modulus of the softest material that a search allows: points then stay
/// where they are, far below a cell's size [-].
inline constexpr double strain_of_searches = 1e-3;

/// The factor, at least 1, of all moduli with which the ground strains no more than that under its own weight.
double stiffening_of(const Domain& domain, const SolveOptions& options);

/// The options with all moduli multiplied by this factor.
SolveOptions stiffened(SolveOptions options, double factor);

/// The options with tan(friction angle) and cohesion of every material divided by the factor, the dilatancy angle no
/// larger than the friction angle that is left; elastic bodies stay as they are.
SolveOptions weakened(SolveOptions options, double factor);

/// The law of a bed with friction and cohesion divided by the factor; a bed that holds, or has no friction, stays.
BaseFriction<double> weakened(BaseFriction<double> bed, double factor);

/// The numbers of all columns of a bed with this law, divided by the factor.
std::vector<Bed<double>> weakened(std::vector<Bed<double>> columns, FrictionLaw law, double factor);

/// The settings of one step that brings gravity on, from time 0 to 1, with the strength divided by `factor`.
SolverSettings static_settings(const SolveOptions& options, const Scene& scene, double factor);

/// The same for backward Euler steps of this length [s], with all gravity there.
SolverSettings falling_settings(const SolveOptions& options, const Scene& scene, double factor, double step);

/// Whether the ground is so narrow, as a strip in plane strain is, that factorising its tangent takes less time than
/// conjugate gradients: few nodes in a section across its longest side.
bool narrow(const ParticleState& points);

}  // namespace talus::solver
