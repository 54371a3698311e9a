// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two elevation models compared: how they are brought together, which changes are believed, and what arrived.
#pragma once

#include <filesystem>

#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

struct Options;

/// What is done about surveys that do not lie on one another.
enum class Alignment { check, apply, off };

/// The keys of [preprocess.coregistration].
struct CoregistrationOptions {
  Alignment mode = Alignment::check;
  std::filesystem::path changed;

  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const Options& all);
};

/// The keys of [preprocess.difference].
struct DifferenceOptions {
  double confidence = 0.95;
  double minimum_level = 0;  ///< [m]
  double sigma = 0;          ///< of the difference [m]; 0: learnt from stable ground

  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const Options& all);
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
  void describe(recipe::Visitor& v, const Options& all);
};

}  // namespace talus::preprocess
