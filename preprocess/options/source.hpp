// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The source: what fails, and how deep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/gis/polygons.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

struct Options;

/// How deep the sliding surface lies that is computed under source.polygon. None given: by the area of the polygon.
struct SlidingSurfaceOptions {
  double depth = 0;   ///< largest vertical one [m]; 0: not given
  double volume = 0;  ///< [m3]; 0: not given
  std::filesystem::path depth_points;
  double depth_points_error = 0;  ///< standard error [m]

  /// How many of depth, volume and points are given.
  int ways_given() const { return (depth > 0) + (volume > 0) + !depth_points.empty(); }
  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const Options& all);
};

/// The keys of [preprocess.source].
struct SourceOptions {
  std::filesystem::path polygon;
  std::string layer = "source";  ///< of `polygon`; empty, or none of that name: the first
  std::string where;             ///< which of its polygons, by attributes; empty: all
  double grow = 0;               ///< of the polygon, outwards [m]
  double threshold = 0.5;        ///< [m]
  std::vector<double> seed;      ///< easting, northing [m]; empty: the largest region
  SlidingSurfaceOptions sliding_surface;

  /// Which polygons of the file are the outline.
  LayerChoice choice() const { return {layer, where}; }
  /// The method declares the keys with defaults, help and what they need of `all` others.
  void describe(recipe::Visitor& v, const Options& all);
};

}  // namespace talus::preprocess
