// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an integrator starts from: the grid's shape, the material points, their loads and what they can touch.
#pragma once

#include <string>
#include <vector>

#include "common/domain/active_cells.hpp"
#include "common/map/raster.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/contact_points.hpp"
#include "solver/grid/terrain.hpp"
#include "solver/integrator/inflow.hpp"
#include "solver/integrator/shaking.hpp"
#include "solver/state/particles.hpp"

namespace talus::solver {

/// The scene that an integrator starts from, in SI units, on the host.
struct Scene {
  MapGrid map;
  GridShape grid;
  TerrainTables terrain;  ///< of that grid
  ActiveCells active;     ///< of the grid at the start, around the points; layers above the bed
  ParticleState points;
  std::vector<double> load_volumes;  ///< volume of the points each load pulls at [m3]
  std::vector<Bed<double>> bed;      ///< of every column; empty where it is the same everywhere
  ContactPoints contacts;
  Shaking shaking;                         ///< of the ground
  Inflow inflow;                           ///< what enters over time
  std::vector<std::string> release_names;  ///< of the domain, then of the inflows
};

}  // namespace talus::solver
