// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles: upright bodies over polygons.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// One [[preprocess.obstacle]]: an upright body over polygons, for [[solve.obstacle]] of the same name.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path polygons;
  std::string attribute = "height";
  double height = 0;  ///< one height for all polygons [m]; 0: that of the attribute

  /// The method declares the keys with defaults and help; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place);
};

/// This function declares the list of obstacles, each of a name of its own.
void describe_obstacles(recipe::Visitor& v, std::vector<ObstacleOptions>& obstacles);

}  // namespace talus::preprocess
