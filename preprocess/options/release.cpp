// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/release.hpp"

#include <fmt/format.h>

#include <set>

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

void ReleaseOptions::describe_thickness(recipe::Visitor& v, const std::string& place, bool needed) {
  v.text("name", name, "its name; empty = release-1 or erodible-1, and so on");
  v.path("thickness_raster", thickness_raster, "raster of thickness [m]; or polygons, below");
  v.path("polygons", polygons, "vector file of polygons");
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

void ReleaseOptions::describe(recipe::Visitor& v, const std::string& place, bool needed) {
  describe_thickness(v, place, needed);
  v.text("layer", layer, "layer of polygons; empty, or none of that name = the first");
  v.text("where", where, "which of the polygons, by their attributes: \"id = 12\"; empty = all");
  v.needs(!needed || where.empty() || !polygons.empty(),
          fault(place + ": where is given without polygons", "a raster of thickness has no attributes",
                "Leave it out, or give the release by polygons"));
  v.text("attribute", attribute, "the polygons' attribute that holds the thickness [m]");
  v.needs(!needed || polygons.empty() || thickness != 0 || !attribute.empty(),
          fault(place + ": polygons without thickness", "attribute is empty and thickness_m is 0",
                "Name the attribute that holds the thickness, or give thickness_m"));
  v.number("volume_factor", volume_factor, recipe::positive, "its thickness, and so its volume, times this");
  v.number("grow_m", grow, recipe::any, "the polygons grown by this on all sides; negative: shrunk");
  v.needs(!needed || grow == 0 || !polygons.empty(),
          fault(place + ": grow_m is given without polygons", "a raster of thickness has no outline to grow",
                "Leave it out, or give the release by polygons"));
  recipe::choice(v, "direction", direction,
                 {{"vertical", Direction::vertical}, {"slope-normal", Direction::slope_normal}},
                 "which way the thickness is measured");
}

void ErodibleOptions::describe(recipe::Visitor& v, const std::string& place, const Options& all) {
  v.flag("lowering", lowering,
         "with before_dem and after_dem: the layer is what went down outside the source; no raster, no polygons");
  v.needs(all.in_laboratory() || !lowering || (!all.after_dem.empty() && thickness_raster.empty() && polygons.empty()),
          fault("erodible: lowering = true beside a raster or polygons, or without after_dem",
                "the layer is the difference of two elevation models",
                "Give before_dem and after_dem and nothing else, or leave lowering out"));
  describe_thickness(v, place, !all.in_laboratory() && !lowering);
}

void describe_layers(recipe::Visitor& v, Options& o) {
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
