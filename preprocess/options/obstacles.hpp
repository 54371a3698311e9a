// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Obstacles: upright bodies over polygons.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// One [[preprocess.obstacle]]: an upright body over polygons, for [[solve.obstacle]] of the same name.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path polygons;
  std::string attribute = "height";
  double height = 0;  ///< one height for all polygons [m]; 0: that of the attribute

  /// The method declares the keys with defaults and help; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place) {
    v.text("name", name, "name of the obstacle, as in [[solve.obstacle]]");
    v.path("polygons", polygons, "vector file of footprints");
    v.needs(!polygons.empty(),
            fault(place + ": polygons is not given", "its footprint is not known", "Name a vector file"));
    v.text("attribute", attribute, "the polygons' attribute that holds their height above the ground [m]");
    v.number("height_m", height, recipe::not_negative, "one height for all of them; 0 = that of the attribute");
  }
};

/// This function declares the list of obstacles, each of a name of its own.
inline void describe_obstacles(recipe::Visitor& v, std::vector<ObstacleOptions>& obstacles) {
  std::set<std::string> names;
  recipe::list(
      v, "obstacle", obstacles,
      "a body in the way, from polygons: written into OUT/obstacles.vdb for [[solve.obstacle]]; may be repeated",
      [&](ObstacleOptions& obstacle, std::size_t item) {
        const std::string& name = obstacle.name;
        const std::string place = fmt::format("obstacle {}", item + 1);
        obstacle.describe(v, place);
        v.needs(!name.empty() && names.insert(name).second,
                fault(fmt::format("{}: name = \"{}\" is {}", place, name, name.empty() ? "empty" : "taken"),
                      "[[solve.obstacle]] finds it by name", "Give it a name of its own"));
      });
}

}  // namespace talus::preprocess
