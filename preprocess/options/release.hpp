// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What fails and how deep (the source), and layers by rasters or polygons: what is released or taken along.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include <fmt/format.h>

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
  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    const bool ignored = all.in_laboratory(), given = ways_given() > 0;
    v.number("depth_m", depth, recipe::not_negative, "largest vertical depth below before_dem; 0 = not given");
    v.number("volume_m3", volume, recipe::not_negative, "volume between it and before_dem; 0 = not given");
    v.path("depth_points", depth_points,
           "places where it is known (boreholes): vector points, or a table of x, y and depth, or z of the surface, in "
           "vertical_unit; none of the three: volume from the polygon's area (Guzzetti et al. 2009)");
    need(v, ignored || ways_given() <= 1,
         "source.sliding_surface: more than one of depth_m, volume_m3 and depth_points is given",
         "each says by itself how deep the surface lies", "Leave the others out");
    need(v, ignored || !given || (!all.before_dem.empty() && all.after_dem.empty() && all.sliding_surface.empty()),
         "source.sliding_surface is given, but not before_dem and source.polygon alone",
         "only there is a sliding surface computed; elsewhere the files hold it",
         "Leave it out, or leave after_dem, sliding_surface and base_dem out");
    v.number("depth_points_error_m", depth_points_error, recipe::not_negative,
             "standard error of these points; 0 = met exactly");
    need(v, ignored || !depth_points.empty() || !(depth_points_error > 0),
         "source.sliding_surface: depth_points_error_m is given without depth_points", "there are no points to read",
         "Give depth_points");
  }
};

/// The keys of [preprocess.source].
struct SourceOptions {
  std::filesystem::path polygon;
  double grow = 0;           ///< of the polygon, outwards [m]
  double threshold = 0.5;    ///< [m]
  std::vector<double> seed;  ///< easting, northing [m]; empty: found
  SlidingSurfaceOptions sliding_surface;

  template <class All>
  void describe(recipe::Visitor& v, const All& all) {
    const bool ignored = all.in_laboratory();
    v.path("polygon", polygon,
           "outline of the source, FILE|layername=LAYER|subset=CONDITION (layer \"source\" or the first, where left "
           "out); empty = found as the connected region of lowering; needed for (5)");
    need(v, ignored || polygon.empty() || all.base_dem.empty(), "source.polygon is given with base_dem",
         "the releases say what fails there", "Use polygons = ... in [[preprocess.release]]");
    v.number("grow_m", grow, recipe::any, "the polygon grown by this on all sides; negative: shrunk");
    need(v, ignored || grow == 0 || !polygon.empty(), "source.grow_m is given without source.polygon",
         "there is no outline to grow", "Give the polygon, or leave it out");
    v.number("threshold_m", threshold, recipe::not_negative, "lowering beyond which a cell belongs to such a region");
    v.numbers("seed_m", seed, recipe::any,
              "[easting, northing]: take the region that holds this point; empty = (1) the one with fall and a deposit "
              "below, (2) the largest by volume");
    need(v, ignored || seed.empty() || seed.size() == 2, fmt::format("source.seed_m has {} values", seed.size()),
         "a point has two", "Give [easting, northing]");
    need(v, ignored || seed.empty() || polygon.empty(), "source.polygon and a seed point are both given",
         "the polygon already says what the source is", "Leave one out");
    recipe::table(v, "sliding_surface", sliding_surface,
                  "(5) how deep the surface lies that is computed under the polygon: give one of the first three", all);
  }
};

/// Which way a thickness is measured.
enum class Direction { vertical, slope_normal };

/// One [[preprocess.release]]: a raster of thickness, or polygons with a thickness.
struct ReleaseOptions {
  std::string name;
  std::filesystem::path thickness_raster;
  std::filesystem::path polygons;
  std::string attribute = "thickness";
  double thickness = 0;  ///< one thickness for all polygons [m]; 0: that of the attribute
  double volume = 0;     ///< to which the thickness is scaled [m3]; 0: as the thickness says
  double grow = 0;       ///< of its polygons, outwards [m]
  Direction direction = Direction::vertical;

  /// Declares the keys, and, where a thickness is `needed`, that one is given; messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place, bool needed) {
    describe_thickness(v, place, needed);
    v.text("attribute", attribute, "the polygons' attribute that holds the thickness [m]");
    v.number("volume_m3", volume, recipe::not_negative,
             "volume of the release: a raster is scaled to it, polygons get one thickness; 0 = as the thickness says");
    need(v, !needed || volume == 0 || thickness == 0, place + ": thickness_m beside volume_m3",
         "each says by itself how much is released", "Leave one out");
    need(v, !needed || polygons.empty() || thickness != 0 || volume != 0 || !attribute.empty(),
         place + ": polygons without thickness", "attribute is empty and thickness_m is 0",
         "Name the attribute that holds the thickness, or give thickness_m or volume_m3");
    v.number("grow_m", grow, recipe::any, "the polygons grown by this on all sides; negative: shrunk");
    need(v, !needed || grow == 0 || !polygons.empty(), place + ": grow_m is given without polygons",
         "a raster of thickness has no outline to grow", "Leave it out, or give the release by polygons");
    recipe::choice(v, "direction", direction,
                   {{"vertical", Direction::vertical}, {"slope-normal", Direction::slope_normal}},
                   "which way the thickness is measured");
  }

 protected:
  /// Declares the keys that an erodible layer has too.
  void describe_thickness(recipe::Visitor& v, const std::string& place, bool needed) {
    v.text("name", name, "its name; empty = release-1 or erodible-1, and so on");
    v.path("thickness_raster", thickness_raster, "raster of thickness [m]; or polygons, below");
    v.path("polygons", polygons,
           "vector file of polygons: FILE|layername=LAYER|subset=CONDITION, the first layer and all where left out");
    need(v, !needed || thickness_raster.empty() != polygons.empty(),
         place + (polygons.empty() ? ": neither thickness_raster nor polygons is given"
                                   : ": thickness_raster and polygons are both given"),
         "a release is one or the other", "Give one; several releases are several [[preprocess.release]]");
    v.number("thickness_m", thickness, recipe::not_negative,
             "one thickness for all polygons; 0 = that of their attribute, of erodible layers \"thickness\"");
    need(v, !needed || thickness_raster.empty() || !(thickness > 0),
         fmt::format("{}: thickness_m = {} beside thickness_raster", place, thickness),
         "the raster holds the thickness", "Leave one out");
  }
};

/// One [[preprocess.erodible]]: a layer of ground by a raster or polygons, or all that was lowered outside the source.
struct ErodibleOptions : ReleaseOptions {
  bool lowering = false;

  /// Declares the keys with defaults, help and what they need of `all` others; messages call the entry `place`.
  template <class All>
  void describe(recipe::Visitor& v, const std::string& place, const All& all) {
    v.flag("lowering", lowering,
           "with before_dem and after_dem: the layer is what went down outside the source; no raster, no polygons");
    need(v,
         all.in_laboratory() || !lowering || (!all.after_dem.empty() && thickness_raster.empty() && polygons.empty()),
         "erodible: lowering = true beside a raster or polygons, or without after_dem",
         "the layer is the difference of two elevation models",
         "Give before_dem and after_dem and nothing else, or leave lowering out");
    describe_thickness(v, place, !all.in_laboratory() && !lowering);
  }
};

/// Declares the lists of releases and erodible layers, whose names are told apart in results.
template <class All>
void describe_layers(recipe::Visitor& v, All& o) {
  std::set<std::string> names;
  const auto need_own_name = [&](const std::string& place, const std::string& name) {
    need(v, o.in_laboratory() || name.empty() || names.insert(name).second,
         fmt::format("{}: name \"{}\" is taken", place, name), "results are told apart by name", "Name it otherwise");
  };
  recipe::list(v, "release", o.release, "what is released onto base_dem; may be repeated",
               [&](ReleaseOptions& release, std::size_t item) {
                 const std::string place = fmt::format("release {}", item + 1);
                 release.describe(v, place, !o.in_laboratory());
                 need_own_name(place, release.name);
               });
  recipe::list(
      v, "erodible", o.erodible,
      "a layer of ground that the slide can take along: material points with a strength of their own; may be repeated",
      [&](ErodibleOptions& layer, std::size_t item) {
        const std::string place = fmt::format("erodible {}", item + 1);
        layer.describe(v, place, o);
        need_own_name(place, layer.name);
      });
  need(v, o.erodible.empty() || !o.in_laboratory(), "erodible does not go with a laboratory",
       "its boxes are not read from maps", "Give the layer as a box");
}

}  // namespace talus::preprocess
