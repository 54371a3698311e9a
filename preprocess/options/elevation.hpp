// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevation models: which there are, and what their heights are in.
#pragma once

#include <filesystem>
#include <string>

#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

struct Options;

/// What the heights of elevation models are in: what the files say, or this. `same`: of one model, as of all the
/// others.
enum class VerticalUnit { declared, metre, foot, us_survey_foot };

/// The keys of [preprocess] itself.
struct ElevationOptions {
  std::filesystem::path before_dem, after_dem, sliding_surface, base_dem;
  std::string working_crs;
  VerticalUnit vertical_unit = VerticalUnit::declared;

  /// The DEM that gives the working grid its CRS, registration and cell.
  const std::filesystem::path& first_dem() const { return base_dem.empty() ? before_dem : base_dem; }
  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const Options& all);
};

}  // namespace talus::preprocess
