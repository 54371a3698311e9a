// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/options.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "preprocess/options/fault.hpp"

namespace talus::preprocess {
namespace {

/// This function declares that the models, the outline and the releases belong to one way of saying what fails. Of
/// several faults the first is named.
void need_one_way(recipe::Visitor& v, const Options& o) {
  const bool before = !o.before_dem.empty(), after = !o.after_dem.empty(), sliding = !o.sliding_surface.empty();
  const bool base = !o.base_dem.empty(), releases = !o.release.empty();
  bool found = o.in_laboratory();
  const auto refuse = [&](bool wrong, const char* what, const char* why) {
    need(v, found || !wrong, what, why,
         "Give exactly one of: before_dem and after_dem; before_dem and sliding_surface; before_dem and "
         "source.polygon; base_dem and [[preprocess.release]]; [preprocess.laboratory] and "
         "[[preprocess.box]]; either of the last two alone with no_release = true where all that moves "
         "enters by [[solve.inflow]]");
    found = found || wrong;
  };
  const char* const two_ways = "they belong to different ways";
  const char* const unclear = "nothing says clearly what lies under the failing mass";
  refuse(!before && !base, "neither before_dem nor base_dem is given", "nothing says what fails");
  refuse(before && base, "before_dem and base_dem are both given", two_ways);
  refuse(before && after && sliding, "after_dem and sliding_surface are both given", unclear);
  refuse(before && !after && !sliding && o.source.polygon.empty(), "before_dem stands alone", unclear);
  refuse(before && releases, "before_dem and [[preprocess.release]] are both given", two_ways);
  refuse(base && (after || sliding), "base_dem goes with releases only, but after_dem or sliding_surface is given",
         two_ways);
  refuse(base && !releases && !o.no_release, "base_dem is given without a release", "nothing would move");
}

}  // namespace

void ElevationOptions::describe(recipe::Visitor& v, const Options& all) {
  v.path("before_dem", before_dem,
         "surface before the slide (1: with after_dem, 2: with sliding_surface, 5: with source.polygon alone)");
  v.path("after_dem", after_dem, "surface after it; only the lowering inside the source is taken out");
  v.path("sliding_surface", sliding_surface, "surface it slides on; no data = no sliding surface there");
  v.path("base_dem", base_dem, "ground under the releases (3: with [[preprocess.release]])");
  need_one_way(v, all);
  v.text(
      "working_crs", working_crs,
      "metric CRS to work in, \"EPSG:32149\", or \"utm\": the UTM zone of the first DEM; files in degrees or feet are "
      "reprojected to it; empty = the CRS of the first DEM");
  recipe::choice(
      v, "vertical_unit", vertical_unit,
      {{"declared", VerticalUnit::declared},
       {"metre", VerticalUnit::metre},
       {"foot", VerticalUnit::foot},
       {"us-survey-foot", VerticalUnit::us_survey_foot}},
      "what the elevation models' heights are in; declared = what each file says, metres where it says nothing");
}

void Options::describe(recipe::Visitor& v) {
  ElevationOptions::describe(v, *this);
  v.names("accept", accept,
          {"swapped-surveys", "doubtful-source", "false-lengths", "steep-ground", "fill-value",
           "different-vertical-datums", "shifted-part"},
          "what is refused because it is hardly ever right, and here is; it goes with all results");
  v.flag("no_release", no_release,
         "base_dem or a laboratory without releases: all that moves enters by [[solve.inflow]]");
  need(v, !no_release || (before_dem.empty() && release.empty() && box.empty()),
       "no_release = true beside before_dem, [[preprocess.release]] or [[preprocess.box]]", "they say what is released",
       "Leave one of them out; an inflow may enter beside a release");
  need(v, !no_release || grid.layer_height > 0, "no_release = true without grid.layer_height_m",
       "there is no release whose thickness it could follow", "Give a half of the depth that the flow will have");
  v.number("thickness_factor", thickness_factor, recipe::positive,
           "the released thickness times this; the bed and the outline stay, the surface before follows");
  need(v, thickness_factor == 1 || std::ranges::all_of(box, [](const auto& b) { return !(b.bottom > 0); }),
       fmt::format("thickness_factor = {:g} with a box whose bottom lies above the ground", thickness_factor),
       "it would be lifted, not made thicker", "Give extent_m of the boxes instead");
  recipe::table(v, "coregistration", coregistration, "for (1): after_dem brought onto before_dem", *this);
  recipe::table(v, "difference", difference, "for (1): after_dem less before_dem, and from where on it is believed",
                *this);
  recipe::table(v, "deposit", deposit, "for (1): what arrived, written for the score", *this);
  recipe::table(v, "source", source, "what fails, for (1), (2) and (5)", *this);
  recipe::table(v, "grid", grid, "background grid and material points");
  recipe::table(v, "voids", voids, "cells without elevation inside the elevation models, and cells that stand out",
                *this);
  describe_layers(v, *this);
  recipe::table(v, "laboratory", laboratory, "(4) a plane instead of elevation models, with [[preprocess.box]]", *this);
  recipe::list(v, "box", box, "a block of material on or above that plane; may be repeated");
  describe_obstacles(v, obstacle);
  describe_places(v, place);
  recipe::table(v, "bed", bed, "friction of the bed from place to place");
}

void Options::check(std::vector<Fault>& faults) const {
  if (laboratory.has_cells() && grid.stands_alone()) check_boxes(*this, faults);
}

Way Options::way() const {
  if (laboratory.given()) return Way::laboratory;
  if (!base_dem.empty()) return Way::base_and_releases;
  if (!after_dem.empty()) return Way::before_and_after;
  return sliding_surface.empty() ? Way::before_and_outline : Way::before_and_sliding_surface;
}

}  // namespace talus::preprocess
