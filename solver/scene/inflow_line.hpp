// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The line that an inflow enters through, and the ground about it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "solver/grid/terrain.hpp"
#include "solver/options/inflow.hpp"
#include "solver/scene/inflow_section.hpp"

namespace talus::solver {

/// A place on the map, or a way [cells from the first node].
using CellPlace = std::array<double, 2>;

/// The ground that inflows enter on.
struct InflowTerrain {
  const GridShape& shape;
  const TerrainTables& terrain;

  /// Whether a point may stand there.
  bool open(const CellPlace& at) const;
  /// The slope along x and y [-].
  CellPlace slope(const CellPlace& at) const;
};

/// The line of an inflow on the map, with the section of ground below it.
struct InflowLine {
  CellPlace from{}, to{};          ///< its ends
  CellPlace ahead{};               ///< unit vector of the flow on the map
  std::vector<CellPlace> middles;  ///< of the strips
  InflowGround ground;
};

/// The line of an inflow; `place` names it in messages. It throws RecipeError where the line lies outside the known
/// ground, or where nothing says which way the flow goes.
InflowLine inflow_line(const InflowOptions& options, const std::string& place, const MapGrid& map,
                       const InflowTerrain& terrain);

}  // namespace talus::solver
