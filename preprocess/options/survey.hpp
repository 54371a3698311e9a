// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two elevation models compared: how they are brought together, which changes are believed, and what arrived.
#pragma once

#include <filesystem>
#include <string>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// Declares that `what`, where it is given, needs a second elevation model.
template <class All>
void need_second_model(recipe::Visitor& v, const All& all, bool given, const std::string& what) {
  v.needs(all.in_laboratory() || !all.after_dem.empty() || !given,
          fault(what + " is given without after_dem", "it speaks of a second elevation model",
                "Give after_dem, or leave it out"));
}

/// What is done about surveys that do not lie on one another.
enum class Alignment { check, apply, off };

/// The keys of [preprocess.coregistration].
struct CoregistrationOptions {
  Alignment mode = Alignment::check;
  std::filesystem::path changed;

  /// The method declares the keys with defaults, help and what they need of `all` others.
  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    recipe::choice(
        v, "mode", mode, {{"check", Alignment::check}, {"apply", Alignment::apply}, {"off", Alignment::off}},
        "bring after_dem onto before_dem where nothing moved: check = find shift, height and tilt, and warn; "
        "apply = correct them");
    need_second_model(v, all, mode == Alignment::apply, "coregistration.mode = \"apply\"");
    v.path(
        "changed", changed,
        "polygons of ground to leave out of the fit, besides source and deposit; changes that stand out are found by "
        "themselves");
    need_second_model(v, all, !changed.empty(), "coregistration.changed");
  }
};

/// The keys of [preprocess.difference].
struct DifferenceOptions {
  double sigma = 0;  ///< of the difference [m]; 0: learnt from stable ground

  /// The method declares the keys with defaults, help and what they need of `all` others.
  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    v.number("sigma_m", sigma, recipe::not_negative,
             "standard error of the difference, the root of the sum of both models' squares; 0 = by slope, from stable "
             "ground");
    need_second_model(v, all, sigma > 0, "difference.sigma_m");
  }
};

/// The keys of [preprocess.deposit]: what arrived, for after_dem.
struct DepositOptions {
  std::filesystem::path polygon;
  double threshold = 0.5;  ///< [m]

  // Fixed numbers without a key (docs/notes/surveys-and-release.md).
  int bridge_cells = 10;      ///< [cells]
  double longest_gap = 1;     ///< over the distance from the crown to where the gap begins
  double steepest_rest = 30;  ///< [deg]
  double sure_levels = 3;     ///< over the level of detection
  int sure_cells = 5;
  double outside_share = 0.2;  ///< of the larger of source and deposit

  /// The method declares the keys with defaults, help and what they need of `all` others.
  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    v.path(
        "polygon", polygon,
        "outline of the surveyed deposit; empty = what rose in the regions of change that belong to the slide: beside "
        "the source, beside one another, or down the way that a flow takes from them");
    need_second_model(v, all, !polygon.empty(), "deposit.polygon");
    v.number("threshold_m", threshold, recipe::not_negative,
             "rise beyond which (and beyond the level of detection) a cell belongs to it");
  }
};

}  // namespace talus::preprocess
