// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an authority asks of the maps: classes of intensity, a cone of reach, numbers by building.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::postprocess {

/// By whose limits intensity is told apart (postprocess/hazard/intensity.hpp).
enum class Guideline {
  none,
  swiss_debris_flow,
  swiss_flood,
  swiss_avalanche,
  debris_flow_concrete,
  debris_flow_other,
  own
};

/// Whether one of the quantities is enough for a class, or all are needed.
enum class Rule { any, all };

/// The keys of [postprocess.intensity].
struct IntensityOptions {
  Guideline guideline = Guideline::none;
  std::vector<double> thickness{}, speed{}, thickness_speed{}, pressure{};  ///< own limits [m], [m/s], [m2/s], [kPa]
  Rule rule = Rule::any;
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

/// The keys of [postprocess.reach_cone].
struct ReachConeOptions {
  std::optional<double> angle{};  ///< of the cone below the horizontal [deg]
  bool by_volume = false;         ///< cones by the published regressions of H/L over volume too
  /// Whether a cone is asked for.
  bool asked() const { return angle || by_volume; }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

/// The keys of [postprocess.buildings].
struct BuildingOptions {
  std::filesystem::path polygons{};
  double pressure_coefficient = 1;   ///< of the thrust over density times speed squared [-]
  std::string attribute = "height";  ///< of the polygons: height above the ground [m]
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::postprocess
