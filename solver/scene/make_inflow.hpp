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

/// What each inflow does at most; throws as make_inflow().
std::vector<InflowSummary> inflow_summaries(const Domain& domain, const SolveOptions& options);

/// Where an inflow enters at its largest discharge: a place of the map, the surface of the flow there, and its speed.
struct InflowTop {
  double x = 0, y = 0, z = 0;  ///< map coordinates and elevation [m]
  double speed = 0;            ///< along the ground [m/s]
};

/// The top of every inflow; throws as make_inflow().
std::vector<InflowTop> inflow_tops(const Domain& domain, const SolveOptions& options);

}  // namespace talus::solver
