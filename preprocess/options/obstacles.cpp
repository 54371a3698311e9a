// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/obstacles.hpp"

#include <fmt/format.h>

#include <set>

#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

void ObstacleOptions::describe(recipe::Visitor& v, const std::string& place) {
  v.text("name", name, "name of the obstacle, as in [[solve.obstacle]]");
  v.path("polygons", polygons, "vector file of footprints");
  v.needs(!polygons.empty(),
          fault(place + ": polygons is not given", "its footprint is not known", "Name a vector file"));
  v.text("attribute", attribute, "the polygons' attribute that holds their height above the ground [m]");
  v.number("height_m", height, recipe::not_negative, "one height for all of them; 0 = that of the attribute");
}

void describe_obstacles(recipe::Visitor& v, std::vector<ObstacleOptions>& obstacles) {
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
