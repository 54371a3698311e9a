// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The options of a recipe's [slides] table: many slides over one elevation model. All three stages read them:
// talus-preprocess cuts a domain for each, talus-solve runs and counts them, talus-postprocess makes maps and a table.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus {

/// A key of the recipe that takes the value of an attribute of each slide's polygon.
struct SlideKeyOptions {
  std::string key;  ///< with all its tables: "solve.base.friction_angle_deg"
  std::string attribute;
  void describe(recipe::Visitor& v);
};

/// A slide that the recipe itself lists.
struct ScenarioOptions {
  std::string name;
  std::filesystem::path outline;  ///< its polygons, a vector source
  std::vector<std::string> set;   ///< "key=value" of the recipe
  void describe(recipe::Visitor& v);
};

/// What becomes of a slide that comes to the edge of its window.
enum class SlideAtEdge { flag, fail };

/// The keys of [slides].
struct SlideOptions {
  std::filesystem::path outlines;  ///< a vector source of polygons, a slide each
  std::string name_from;           ///< attribute; empty: not given
  std::optional<double> margin;    ///< around the outline [m]
  double reach_angle = 11;         ///< of the window where no margin is given [degrees]
  SlideAtEdge at_edge = SlideAtEdge::flag;
  std::vector<SlideKeyOptions> vary;
  std::vector<ScenarioOptions> scenario;
  void describe(recipe::Visitor& v);
  /// The method adds the faults of keys that contradict one another.
  void check(std::vector<Fault>& faults) const;

  /// Whether the recipe asks for many slides.
  bool on() const { return !outlines.empty() || !scenario.empty(); }
};

/// The [slides] of a recipe; not on where it has none. Throws RecipeError.
SlideOptions slides_of(const recipe::Recipe& recipe);

}  // namespace talus
