// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Layers given by rasters or polygons: what is released, and what can be taken along.
#pragma once

#include <filesystem>
#include <string>

#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

struct Options;

/// Which way a thickness is measured.
enum class Direction { vertical, slope_normal };

/// One [[preprocess.release]]: a raster of thickness, or polygons with a thickness.
struct ReleaseOptions {
  std::string name;
  std::filesystem::path thickness_raster;
  std::filesystem::path polygons;
  std::string layer;  ///< of `polygons`; empty: the first
  std::string where;  ///< which of them, by attributes; empty: all
  std::string attribute = "thickness";
  double thickness = 0;      ///< one thickness for all polygons [m]; 0: that of the attribute
  double volume_factor = 1;  ///< of its thickness, and so of its volume [-]
  double grow = 0;           ///< of its polygons, outwards [m]
  Direction direction = Direction::vertical;

  /// The method declares the keys with defaults and help, and, where a thickness is `needed`, that one is given;
  /// messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place, bool needed);

 protected:
  /// Declares the keys that an erodible layer has too.
  void describe_thickness(recipe::Visitor& v, const std::string& place, bool needed);
};

/// One [[preprocess.erodible]]: a layer of ground by a raster or polygons, or all that was lowered outside the source.
struct ErodibleOptions : ReleaseOptions {
  bool lowering = false;

  /// The method declares the keys with defaults, help and what they need of `all` others; messages call the entry
  /// `place`.
  void describe(recipe::Visitor& v, const std::string& place, const Options& all);
};

/// This function declares the lists of releases and erodible layers, whose names are told apart in results.
void describe_layers(recipe::Visitor& v, Options& options);

}  // namespace talus::preprocess
