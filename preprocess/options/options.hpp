// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What [preprocess] of a recipe holds. Every key is named once, in describe().
#pragma once

#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/bed.hpp"
#include "preprocess/options/elevation.hpp"
#include "preprocess/options/grid.hpp"
#include "preprocess/options/laboratory.hpp"
#include "preprocess/options/places.hpp"
#include "preprocess/options/release.hpp"

namespace talus::preprocess {

/// The five ways of saying what fails.
enum class Way { before_and_after, before_and_sliding_surface, before_and_outline, base_and_releases, laboratory };

/// The keys of [preprocess] itself, then its tables.
struct Options : ElevationOptions {
  std::vector<std::string> accept;  ///< what is refused as implausible, insisted on by name
  bool no_release = false;          ///< all that moves enters over time ([[solve.inflow]])
  double thickness_factor = 1;      ///< of the released thickness [-]
  CoregistrationOptions coregistration;
  DifferenceOptions difference;
  SourceOptions source;
  DepositOptions deposit;
  GridOptions grid;
  VoidOptions voids;
  std::vector<ReleaseOptions> release;
  std::vector<ErodibleOptions> erodible;
  LaboratoryOptions laboratory;
  std::vector<BoxOptions> box;
  BedRasters bed;
  std::vector<ObstacleOptions> obstacle;
  std::vector<PlaceOptions> place;

  /// Whether the keys of a laboratory are given, all or some; what else is given is not looked at then.
  bool in_laboratory() const { return laboratory.given() || !box.empty(); }
  /// The way that is meant, of options in which recipe::find_unmet() finds nothing.
  Way way() const;
  /// Declares all keys of [preprocess] and its tables with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
  /// Adds the faults that the boxes of a laboratory have together to `faults`.
  void check(std::vector<Fault>& faults) const;
};

}  // namespace talus::preprocess
