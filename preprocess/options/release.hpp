// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Layers given by rasters or polygons: what is released, and what can be taken along.
#pragma once

#include <fmt/format.h>

#include <filesystem>
#include <set>
#include <string>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

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

  /// The method declares the keys with defaults and help, and, where a thickness is `needed`, that one is given;
  /// messages call the entry `place`.
  void describe(recipe::Visitor& v, const std::string& place, bool needed) {
    describe_thickness(v, place, needed);
    v.text("attribute", attribute, "the polygons' attribute that holds the thickness [m]");
    v.number("volume_m3", volume, recipe::not_negative,
             "volume of the release: a raster is scaled to it, polygons get one thickness; 0 = as the thickness says");
    v.needs(
        !needed || volume == 0 || thickness == 0,
        fault(place + ": thickness_m beside volume_m3", "each says by itself how much is released", "Leave one out"));
    v.needs(!needed || polygons.empty() || thickness != 0 || volume != 0 || !attribute.empty(),
            fault(place + ": polygons without thickness", "attribute is empty and thickness_m is 0",
                  "Name the attribute that holds the thickness, or give thickness_m or volume_m3"));
    v.number("grow_m", grow, recipe::any, "the polygons grown by this on all sides; negative: shrunk");
    v.needs(!needed || grow == 0 || !polygons.empty(),
            fault(place + ": grow_m is given without polygons", "a raster of thickness has no outline to grow",
                  "Leave it out, or give the release by polygons"));
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
    v.needs(!needed || thickness_raster.empty() != polygons.empty(),
            fault(place + (polygons.empty() ? ": neither thickness_raster nor polygons is given"
                                            : ": thickness_raster and polygons are both given"),
                  "a release is one or the other", "Give one; several releases are several [[preprocess.release]]"));
    v.number("thickness_m", thickness, recipe::not_negative,
             "one thickness for all polygons; 0 = that of their attribute, of erodible layers \"thickness\"");
    v.needs(!needed || thickness_raster.empty() || !(thickness > 0),
            fault(fmt::format("{}: thickness_m = {} beside thickness_raster", place, thickness),
                  "the raster holds the thickness", "Leave one out"));
  }
};

/// One [[preprocess.erodible]]: a layer of ground by a raster or polygons, or all that was lowered outside the source.
struct ErodibleOptions : ReleaseOptions {
  bool lowering = false;

  /// The method declares the keys with defaults, help and what they need of `all` others; messages call the entry
  /// `place`.
  template <class All>
  void describe(recipe::Visitor& v, const std::string& place, const All& all) {
    v.flag("lowering", lowering,
           "with before_dem and after_dem: the layer is what went down outside the source; no raster, no polygons");
    v.needs(
        all.in_laboratory() || !lowering || (!all.after_dem.empty() && thickness_raster.empty() && polygons.empty()),
        fault("erodible: lowering = true beside a raster or polygons, or without after_dem",
              "the layer is the difference of two elevation models",
              "Give before_dem and after_dem and nothing else, or leave lowering out"));
    describe_thickness(v, place, !all.in_laboratory() && !lowering);
  }
};

/// This function declares the lists of releases and erodible layers, whose names are told apart in results.
template <class All>
void describe_layers(recipe::Visitor& v, All& o) {
  std::set<std::string> names;
  const auto need_own_name = [&](const std::string& place, const std::string& name) {
    v.needs(o.in_laboratory() || name.empty() || names.insert(name).second,
            fault(fmt::format("{}: name \"{}\" is taken", place, name), "results are told apart by name",
                  "Name it otherwise"));
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
  v.needs(
      o.erodible.empty() || !o.in_laboratory(),
      fault("erodible does not go with a laboratory", "its boxes are not read from maps", "Give the layer as a box"));
}

}  // namespace talus::preprocess
