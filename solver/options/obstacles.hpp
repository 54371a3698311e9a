// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Options of obstacles: bodies that the mass meets between the nodes.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/domain/level_set.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::solver {

/// The keys of [[solve.obstacle]]: a body that the mass meets between the nodes.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path level_set;  ///< empty: OUT/obstacles.vdb
  std::string grid;            ///< in that file; empty: the obstacle's name, or the only one of a file that is given
  BodyInMemory body = {};      ///< instead of a file; no key
  double friction_angle = 20;  ///< [deg]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v) {
    v.text("name", name, "under which its force is recorded");
    v.path("level_set", level_set,
           "OpenVDB file of signed distances [m], negative inside; empty: obstacles.vdb in the output folder "
           "(talus-preprocess)");
    v.text(
        "grid", grid,
        "name of the level set in that file; empty: the obstacle's own, or the only one of a level_set that is given");
    v.number("friction_angle_deg", friction_angle, recipe::Range{0, 90, false, true}, "friction angle of its surface");
  }
};

}  // namespace talus::solver
