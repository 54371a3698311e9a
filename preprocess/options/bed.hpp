// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's friction from place to place: rasters of its numbers, and zones.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/domain/bed_numbers.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// One [[preprocess.bed.zone]]: Voellmy's numbers for some heights, some ground, some volumes or some return period, a
/// row of the tables by which guidelines give them. What is not given sets no bound.
struct BedZone {
  std::filesystem::path polygons{};
  std::optional<double> from{}, to{};                         ///< elevations [m]
  std::optional<double> smallest_volume{}, largest_volume{};  ///< of all that is released [m3]
  std::optional<double> return_period_years{};                ///< of [preprocess.bed]
  std::optional<double> friction_coefficient{};               ///< mu [-]
  std::optional<double> added_coefficient{};                  ///< to the mu of the rows above [-]
  std::optional<double> turbulence{};                         ///< xi [m/s2]

  /// The method declares the keys with defaults, help and what they need; messages call the entry `place`, and `chosen`
  /// is the return period of the recipe.
  void describe(recipe::Visitor& v, const std::string& place, const std::optional<double>& chosen);
  /// Whether the row holds for a released volume [m3] and a return period.
  bool holds_for(double volume, const std::optional<double>& return_period) const;
};

/// The keys of [preprocess.bed]: rasters under the names of the numbers in [solve.base] that they take the place of,
/// polygons with the same numbers as attributes, and zones; each is laid over those before.
struct BedRasters {
  std::vector<std::pair<std::string, std::filesystem::path>> files;
  std::filesystem::path polygons;  ///< with the numbers as attributes
  std::optional<double> return_period_years;
  std::vector<BedZone> zones;

  BedRasters() {
    for (const std::string_view key : bed_numbers) files.emplace_back(key, std::filesystem::path());
  }
  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::preprocess
