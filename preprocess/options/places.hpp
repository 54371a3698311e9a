// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and points of vector files that talus-solve asks for: sections, gauges, lines of inflows.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/gis/polygons.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// The attribute that names lines and points where the recipe says nothing; a layer may lack it.
inline constexpr auto usual_name_attribute = "name";

/// One [[preprocess.place]]: lines or points of a vector file, for `place = "..."` in [[solve.section]],
/// [[solve.gauge]] and [[solve.inflow]].
struct PlaceOptions {
  std::string name;
  std::filesystem::path file;
  std::string layer;  ///< of `file`; empty: the first
  std::string where;  ///< which of its features, by attributes; empty: all
  std::string attribute = usual_name_attribute;

  /// Which features of the file they are.
  LayerChoice choice() const { return {layer, where}; }
  /// The method declares the keys with defaults and help; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place);
};

/// This function declares the list of places, each of a name of its own.
void describe_places(recipe::Visitor& v, std::vector<PlaceOptions>& places);

}  // namespace talus::preprocess
