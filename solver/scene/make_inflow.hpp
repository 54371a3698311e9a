// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points that enter a scene over time, from the recipe's inflows (T44).
#pragma once

#include <vector>

#include "common/domain/domain.hpp"
#include "solver/grid/terrain.hpp"
#include "solver/integrator/inflow.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// What enters until the end of the run, with ids after the scene's `seeded` points. It throws RecipeError and
/// DataError where an inflow cannot be: no known ground, a flow deeper than wide or faster than 100 m/s, too many
/// points.
Inflow make_inflow(const Domain& domain, const SolveOptions& options, const GridShape& shape,
                   const TerrainTables& terrain);

}  // namespace talus::solver
