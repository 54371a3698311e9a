// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Start from equilibrium: gravity brought on in quasi-static steps before the run begins.
#pragma once

#include "common/stage/stage.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/any_device.hpp"

namespace talus::solver {

/// The points of a scene with the elastic state of the mass at rest under its own weight, held at its bed, after
/// `gravity_loading_steps` quasi-static steps. Throws NumericalError when a step does not converge.
ParticleState loaded_by_gravity(const Scene& scene, const SolveOptions& options, const AnyDevice& device);

}  // namespace talus::solver
