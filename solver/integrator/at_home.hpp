// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Points put back into the cells that they were sorted by, so that they are sorted as they were once more.
#pragma once

#include "solver/integrator/solver.hpp"

namespace talus::solver {

/// The points of a state that has homes, each in its home cell and the octant of it that its key names: a sort leaves
/// them in their order, with the same keys. `columns`: of the grid.
ParticleState at_home(const SolverState& state, int columns);

}  // namespace talus::solver
