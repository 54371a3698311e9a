// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's friction from place to place: rasters of its numbers, and zones.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "common/domain/bed_numbers.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// One [[preprocess.bed.zone]]: Voellmy's numbers for some heights, some ground, some volumes or some return period, a
/// row of the tables by which guidelines give them. What is not given sets no bound.
struct BedZone {
  std::filesystem::path polygons{};
  std::optional<double> from{}, to{};            ///< elevations [m]
  std::optional<double> friction_coefficient{};  ///< mu [-]
  std::optional<double> added_coefficient{};     ///< to the mu of the rows above [-]
  std::optional<double> turbulence{};            ///< xi [m/s2]

  /// The method declares the keys with defaults, help and what they need; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place);
};

/// One [[preprocess.bed.raster]].
struct BedRaster {
  int number = 0;  ///< of bed_numbers
  std::filesystem::path file{};

  /// Key of the number in [solve.base].
  std::string_view name() const { return bed_numbers.at(static_cast<std::size_t>(number)); }
  /// Declares the keys with defaults, help and what they need; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place);
};

/// The keys of [preprocess.bed]: rasters under the names of the numbers in [solve.base] that they take the place of,
/// polygons with the same numbers as attributes, and zones; each is laid over those before.
struct BedRasters {
  std::vector<BedRaster> rasters;
  std::filesystem::path polygons;  ///< with the numbers as attributes
  std::vector<BedZone> zones;

  /// The method declares the keys with defaults and help.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::preprocess
