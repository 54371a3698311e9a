// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run writes, and how often; names of the things that have columns of the history.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::solver {

/// This function declares that every item of [[solve.TABLE]] has a name of its own that is fit for the names of
/// columns. `why` says what the names are for. An item without one takes the names that a place of the domain has.
void need_names(recipe::Visitor& v, const std::string& table, const std::string& why,
                const std::vector<std::optional<std::string>>& names);
/// Declares the same of items with a member `name`.
template <class Item>
void need_names(recipe::Visitor& v, const std::string& table, const std::string& why, const std::vector<Item>& items) {
  std::vector<std::optional<std::string>> names;
  names.reserve(items.size());
  for (const Item& item : items) {
    names.push_back(item.name);
    if constexpr (requires { item.place; }) {
      if (item.name.empty() && !item.place.empty()) names.back().reset();
    }
  }
  need_names(v, table, why, names);
}

struct SolveOptions;

/// The names of what is implausible in a scene (solver/plan/plan.hpp), as `accept` takes them.
/// "torn-body" is met, if at all, as a run goes on.
inline constexpr const char* torn_body = "torn-body";
inline constexpr const char* acceptable[] = {"weight-strain", "slow-waves",     "fast-waves",
                                             "strong-loads",  "strong-shaking", torn_body};

/// The keys of [[solve.gauge]]: a point of the map at which the mass is watched.
struct GaugeOptions {
  std::string name;
  double x = 0, y = 0;     ///< map coordinates, at_m [m]
  std::string place = {};  ///< of the domain, whose points they are (solver/plan/named_places.hpp); empty: x and y
  void describe(recipe::Visitor& v);
};

/// The keys of [[solve.section]]: a line on the map through which the mass is counted.
struct SectionOptions {
  std::string name;
  recipe::Pairs line = {};  ///< map coordinates of its points, in order [m]
  std::string place = {};   ///< of the domain, whose lines they are; empty: `line`
  void describe(recipe::Visitor& v);
};

/// What frames hold of the material points.
enum class FramePoints { none, rounded, exact };

/// The keys of [solve] for what a run writes.
struct OutputOptions {
  double frame_interval = 10;           ///< [s]
  double history_interval = 0.5;        ///< [s]
  double checkpoint_interval = 0;       ///< simulated [s]; 0: only when interrupted
  std::optional<double> map_threshold;  ///< [m]; empty: by the release, which plan() settles
  FramePoints point_frames = FramePoints::rounded;
  bool energy_budget = false;
  bool deterministic = false;
  std::vector<std::string> accept;  ///< what is refused as implausible, insisted on by name
  std::vector<GaugeOptions> gauges;
  std::vector<SectionOptions> sections;
  void describe(recipe::Visitor& v, const SolveOptions& all);
};

}  // namespace talus::solver
