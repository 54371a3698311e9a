// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The surfaces of obstacles, which lie between the nodes of the grid. They are points with a normal and an area, finer
// than the nodes; contact_impulses.hpp and contact_forces.hpp act on them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/domain/level_set.hpp"
#include "common/map/raster.hpp"
#include "solver/grid/terrain.hpp"

namespace talus::solver {

/// An obstacle: a body that the mass meets between the nodes.
struct Obstacle {
  std::string name;
  std::filesystem::path level_set;  ///< OpenVDB file of signed distances [m], negative inside
  std::string grid;                 ///< in that file; empty: the only one
  BodyInMemory body = {};           ///< instead of a file
  double friction = 0;              ///< coefficient of its surface [-]
};

/// The points of the surfaces, on the host. They do not move and are sorted by the grid's blocks of columns.
struct ContactPoints {
  std::vector<int> cell[3];                         ///< nearest node
  std::vector<double> offset[3];                    ///< from it, in cells [-0.5, 0.5)
  std::vector<Vec3<double>> normal;                 ///< outward, where the mass is
  std::vector<double> area;                         ///< [m2]
  std::vector<int> body;                            ///< index of the obstacle
  std::vector<double> friction;                     ///< coefficient of every obstacle [-]
  std::vector<std::string> notes;                   ///< a line on every obstacle
  std::size_t size() const { return body.size(); }  ///< number of points
};

/// The history of the contact points of a run, three numbers for each; empty at the start.
struct ContactState {
  std::vector<double> force;    ///< on the mass, last step [N]
  std::vector<double> impulse;  ///< on the mass so far [N s]
};

/// This function makes the points of the obstacles' surfaces, at most half a cell apart along each axis. It throws
/// DataError for a level set that cannot be read or lies wholly outside the ground.
ContactPoints make_contact_points(const MapGrid& map, const GridShape& shape, const TerrainTables& ground,
                                  const std::vector<Obstacle>& obstacles);

}  // namespace talus::solver
