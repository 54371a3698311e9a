// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/options/elevation.hpp"

#include "preprocess/options/fault.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

namespace {

/// This function declares that the models, the outline and the releases belong to one way of saying what fails. Of
/// several faults the first is named.
void need_one_way(recipe::Visitor& v, const Options& o) {
  const bool before = !o.before_dem.empty(), after = !o.after_dem.empty(), sliding = !o.sliding_surface.empty();
  const bool base = !o.base_dem.empty(), releases = !o.release.empty();
  bool found = o.in_laboratory();
  const auto refuse = [&](bool wrong, const char* what, const char* why) {
    v.needs(found || !wrong,
            fault(what, why,
                  "Give exactly one of: before_dem and after_dem; before_dem and sliding_surface; before_dem and "
                  "source.polygon; base_dem and [[preprocess.release]]; [preprocess.laboratory] and "
                  "[[preprocess.box]]; either of the last two alone with no_release = true where all that moves "
                  "enters by [[solve.inflow]]"));
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

}  // namespace talus::preprocess
