// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// From a domain and a recipe to the scene that an integrator starts from.
#pragma once

#include <array>
#include <cmath>
#include <functional>
#include <vector>

#include "common/domain/domain.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// Finds the nearest node of a position in cells, and the offset from it.
inline void place_in_cells(double position, int& cell, double& offset) {
  const double nearest = std::floor(position + 0.5);
  cell = static_cast<int>(nearest);
  offset = position - nearest;
}

/// Lays the two sides of point p, `wide` along x and `deep` along y [m], along the ground below it.
void lay_sides(ParticleState& points, std::size_t p, const GridShape& shape, const TerrainTables& terrain, double wide,
               double deep);

/// This function places the seeds of a domain on the background grid. It throws DataError when a seed lies outside the
/// ground, or outside the active cells that the domain's file names.
Scene make_scene(const Domain& domain, const SolveOptions& options);

/// What of a scene no stepping changes: grid, terrain tables, inflows, shaking. Throws RecipeError and DataError.
Scene begin_scene(const Domain& domain, const SolveOptions& options);

/// That scene with its points, bed and contacts, for steps as the options settle them; it throws as make_scene().
Scene finish_scene(const Domain& domain, const SolveOptions& options, Scene begun);

/// The options with the thickness from which cells count: where the recipe gives none, that of the domain's release
/// (covering_thickness).
SolveOptions with_map_threshold(SolveOptions options, const Domain& domain);

/// The shape of the background grid as the domain and the recipe give it.
GridShape grid_shape(const Domain& domain, const SolveOptions& options);

/// Calls visit(friction) with the law of the bed of every cell of the map: the numbers of the domain's rasters where
/// they have some, the recipe's elsewhere.
void each_bed(const Domain& domain, const SolveOptions& options,
              const std::function<void(const BaseFriction<double>&)>& visit);

/// The law of the bed with its numbers, and which of them the domain's rasters give instead.
std::string bed_sentence(const Domain& domain, const SolveOptions& options);

/// The positions of points in map coordinates [m].
std::vector<std::array<double, 3>> positions(const Scene& scene, const ParticleState& points);

struct FirstWaves {
  double speed;                 ///< [m/s]
  bool bound_by_layers = true;  ///< those across the layers too
};

/// Those of a recipe: of the fastest of its materials.
FirstWaves first_waves(const SolveOptions& options);

/// An upper bound of (wave speed + speed) over cell size for points that move at `speed`, for the first step [1/s].
double first_rate(const GridShape& shape, const TerrainTables& terrain, const ParticleState& points,
                  const FirstWaves& waves, double speed);

/// The explicit step of a scene whose mass moves at `speed` [m/s], by the cfl of the options [s].
double explicit_step(const Scene& scene, const SolveOptions& options, double speed);

}  // namespace talus::solver
