// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Options of obstacles: bodies that the mass meets between the nodes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

/// The keys of [[solve.obstacle]]: a body that the mass meets between the nodes.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path level_set;  ///< empty: OUT/obstacles.vdb
  std::string grid;            ///< in that file; empty: the obstacle's name, or the only one of a file that is given
  double friction_angle = 20;  ///< [deg]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::solver
