// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What talus-solve asks for by name: obstacles, upright bodies over polygons; lines and points of vector files for
// sections, gauges and inflows.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "common/domain/domain_place.hpp"
#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// One [[preprocess.obstacle]]: an upright body over polygons, for [[solve.obstacle]] of the same name.
struct ObstacleOptions {
  std::string name;
  std::filesystem::path polygons;
  std::string attribute = "height";
  double height = 0;  ///< one height for all polygons [m]; 0: that of the attribute

  /// Declares the keys with defaults and help; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place) {
    v.text("name", name, "name of the obstacle, as in [[solve.obstacle]]");
    v.path("polygons", polygons, "vector file of footprints");
    need(v, !polygons.empty(), place + ": polygons is not given", "its footprint is not known", "Name a vector file");
    v.text("attribute", attribute, "the polygons' attribute that holds their height above the ground [m]");
    v.number("height_m", height, recipe::not_negative, "one height for all of them; 0 = that of the attribute");
  }
};

/// Declares the list of obstacles, each of a name of its own.
inline void describe_obstacles(recipe::Visitor& v, std::vector<ObstacleOptions>& obstacles) {
  std::set<std::string> names;
  recipe::list(
      v, "obstacle", obstacles,
      "a body in the way, from polygons: written into OUT/obstacles.vdb for [[solve.obstacle]]; may be repeated",
      [&](ObstacleOptions& obstacle, std::size_t item) {
        const std::string& name = obstacle.name;
        const std::string place = fmt::format("obstacle {}", item + 1);
        obstacle.describe(v, place);
        need(v, !name.empty() && names.insert(name).second,
             fmt::format("{}: name = \"{}\" is {}", place, name, name.empty() ? "empty" : "taken"),
             "[[solve.obstacle]] finds it by name", "Give it a name of its own");
      });
}

/// The attribute that names lines and points where the recipe says nothing; a layer may lack it.
inline constexpr auto usual_name_attribute = "name";

/// One [[preprocess.place]]: lines or points of a vector file, for `place = "..."` of sections, gauges and inflows.
struct PlaceOptions {
  std::string name;
  std::filesystem::path file;
  std::string attribute = usual_name_attribute;

  /// Declares the keys with defaults and help; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place) {
    v.text("name", name,
           "by which [[solve.section]], [[solve.gauge]] and [[solve.inflow]] ask for it: place = \"...\"");
    v.path("file", file,
           "vector file of lines (sections, inflows) or points (gauges): FILE|layername=LAYER|subset=CONDITION");
    need(v, !file.empty(), place + ": file is not given", "there is nothing to read", "Name a vector file");
    v.text("attribute", attribute,
           "the attribute that names each line or point; where a layer has no \"name\" they are NAME-1, NAME-2, ... by "
           "the numbers of their features");
    need(v, !attribute.empty(), place + ": attribute is empty", "lines and points are recorded under their names",
         "Name an attribute, or leave the key out");
  }
};

/// Declares the list of places, each of a name of its own.
inline void describe_places(recipe::Visitor& v, std::vector<PlaceOptions>& places) {
  std::set<std::string> names;
  recipe::list(v, "place", places,
               "lines or points of a vector file, for sections, gauges and inflows of [solve]; may be repeated",
               [&](PlaceOptions& one, std::size_t item) {
                 const std::string place = fmt::format("place {}", item + 1);
                 one.describe(v, place);
                 const bool plain = is_plain_name(one.name);
                 need(v, plain, fmt::format("{}: name = \"{}\"", place, one.name), "[solve] asks for it by name",
                      "Give it one of letters, digits, - and _");
                 need(v, !plain || names.insert(one.name).second,
                      fmt::format("{}: name = \"{}\" is taken", place, one.name), "[solve] asks for it by name",
                      "Give it a name of its own");
               });
}

}  // namespace talus::preprocess
