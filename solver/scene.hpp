// A scene as the integrator takes it: grid and points, made from a domain and a recipe.
#pragma once

#include <array>
#include <vector>

#include "common/volume/domain.hpp"
#include "solver/contact/contact_points.hpp"
#include "solver/grid/sparse_grid.hpp"
#include "solver/options.hpp"

namespace talus::solver {

struct Scene {
  MapGrid map;
  GridShape grid;
  ParticleState points;
  std::vector<double> load_volumes;  // volume of the points each load pulls at [m3]
  std::vector<Bed<double>> bed;      // of every column; empty where it is the same everywhere
  ContactPoints contacts;
};

/// Places the seeds of a domain on the background grid. Throws DataError when a seed stands outside the ground.
Scene make_scene(const Domain& domain, const SolveOptions& options);

/// Positions of points in map coordinates [m].
std::vector<std::array<double, 3>> positions(const MapGrid& map, const GridShape& shape, const GroundTables& ground,
                                             const ParticleState& points);

/// An upper bound of (wave speed + speed) over cell size for points at rest or moving at `speed`, for the first step
/// [1/s].
double first_rate(const GridShape& shape, const GroundTables& ground, const ParticleState& points, double wave_speed,
                  double speed);

}  // namespace talus::solver
