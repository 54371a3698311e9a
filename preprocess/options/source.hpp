// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The source: what fails, and how deep.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// How deep the sliding surface lies that is computed under source.polygon. None given: by the area of the polygon.
struct SlidingSurfaceOptions {
  double depth = 0;   ///< largest vertical one [m]; 0: not given
  double volume = 0;  ///< [m3]; 0: not given
  std::filesystem::path depth_points;
  double depth_points_error = 0;  ///< standard error [m]

  /// How many of depth, volume and points are given.
  int ways_given() const { return (depth > 0) + (volume > 0) + !depth_points.empty(); }
  /// The method declares the keys with defaults, help and what they need of `all` others.
  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    const bool ignored = all.in_laboratory(), given = ways_given() > 0;
    v.number("depth_m", depth, recipe::not_negative, "largest vertical depth below before_dem; 0 = not given");
    v.number("volume_m3", volume, recipe::not_negative, "volume between it and before_dem; 0 = not given");
    v.path("depth_points", depth_points,
           "places where it is known (boreholes): vector points, or a table of x, y and depth, or z of the surface, in "
           "vertical_unit; none of the three: volume from the polygon's area (Guzzetti et al. 2009)");
    v.needs(ignored || ways_given() <= 1,
            fault("source.sliding_surface: more than one of depth_m, volume_m3 and depth_points is given",
                  "each says by itself how deep the surface lies", "Leave the others out"));
    v.needs(ignored || !given || (!all.before_dem.empty() && all.after_dem.empty() && all.sliding_surface.empty()),
            fault("source.sliding_surface is given, but not before_dem and source.polygon alone",
                  "only there is a sliding surface computed; elsewhere the files hold it",
                  "Leave it out, or leave after_dem, sliding_surface and base_dem out"));
    v.number("depth_points_error_m", depth_points_error, recipe::not_negative,
             "standard error of these points; 0 = met exactly");
    v.needs(ignored || !depth_points.empty() || !(depth_points_error > 0),
            fault("source.sliding_surface: depth_points_error_m is given without depth_points",
                  "there are no points to read", "Give depth_points"));
  }
};

/// The keys of [preprocess.source].
struct SourceOptions {
  std::filesystem::path polygon;
  double grow = 0;           ///< of the polygon, outwards [m]
  double threshold = 0.5;    ///< [m]
  std::vector<double> seed;  ///< easting, northing [m]; empty: the largest region
  SlidingSurfaceOptions sliding_surface;

  /// The method declares the keys with defaults, help and what they need of `all` others.
  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    const bool ignored = all.in_laboratory();
    v.path("polygon", polygon,
           "outline of the source, FILE|layername=LAYER|subset=CONDITION (layer \"source\" or the first, where left "
           "out); empty = found as the connected region of lowering; needed for (5)");
    v.needs(ignored || polygon.empty() || all.base_dem.empty(),
            fault("source.polygon is given with base_dem", "the releases say what fails there",
                  "Use polygons = ... in [[preprocess.release]]"));
    v.number("grow_m", grow, recipe::any, "the polygon grown by this on all sides; negative: shrunk");
    v.needs(ignored || grow == 0 || !polygon.empty(),
            fault("source.grow_m is given without source.polygon", "there is no outline to grow",
                  "Give the polygon, or leave it out"));
    v.number("threshold_m", threshold, recipe::not_negative, "lowering beyond which a cell belongs to such a region");
    v.numbers("seed_m", seed, recipe::any,
              "[easting, northing]: take the region that holds this point; empty = the largest by volume");
    v.needs(ignored || seed.empty() || seed.size() == 2, fault(fmt::format("source.seed_m has {} values", seed.size()),
                                                               "a point has two", "Give [easting, northing]"));
    v.needs(ignored || seed.empty() || polygon.empty(),
            fault("source.polygon and a seed point are both given", "the polygon already says what the source is",
                  "Leave one out"));
    recipe::table(v, "sliding_surface", sliding_surface,
                  "(5) how deep the surface lies that is computed under the polygon: give one of the first three", all);
  }
};

}  // namespace talus::preprocess
