#include "preprocess/options/options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <set>

#include "preprocess/options/laboratory.hpp"

namespace talus::preprocess {

void ReleaseOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of this release; empty = release-1, release-2, ...");
  v.path("thickness_raster", thickness_raster, "raster of thickness [m]; or polygons, below");
  v.path("polygons", polygons, "vector file of polygons");
  v.text("attribute", attribute, "the polygons' attribute that holds the thickness [m]");
  v.number("thickness_m", thickness, recipe::not_negative, "one thickness for all polygons; 0 = that of the attribute");
  recipe::choice(v, "direction", direction,
                 {{"vertical", Direction::vertical}, {"slope-normal", Direction::slope_normal}},
                 "which way the thickness is measured");
}

void ErodibleOptions::describe(recipe::Visitor& v) {
  v.flag("lowering", lowering,
         "with before_dem and after_dem: the layer is what went down outside the source; no raster, no polygons");
  ReleaseOptions::describe(v);
}

void SlidingSurfaceOptions::describe(recipe::Visitor& v) {
  v.number("depth_m", depth, recipe::not_negative, "largest vertical depth below before_dem; 0 = not given");
  v.number("volume_m3", volume, recipe::not_negative, "volume between it and before_dem; 0 = not given");
  v.path("depth_points", depth_points,
         "places where it is known (boreholes): vector points, or a table of x, y and z or depth, heights in "
         "vertical_unit; none of the three: volume from the polygon's area (Guzzetti et al. 2009)");
  recipe::choice(v, "depth_points_hold", depth_points_hold,
                 {{"elevation", PointValue::elevation}, {"depth", PointValue::depth}},
                 "what the z of these points is where it is not named depth: elevation of the sliding surface, or its "
                 "vertical depth below before_dem");
  v.number("depth_points_error_m", depth_points_error, recipe::not_negative,
           "standard error of these points; 0 = met exactly");
}

void SourceOptions::describe(recipe::Visitor& v) {
  v.path("polygon", polygon,
         "outline of the source; empty = found as the connected region of lowering; needed for (5)");
  v.number("threshold_m", threshold, recipe::not_negative, "lowering beyond which a cell belongs to such a region");
  v.optional_number("seed_x_m", seed_x, recipe::any,
                    "take the region that holds this point (its easting); else the largest by volume");
  v.optional_number("seed_y_m", seed_y, recipe::any, "its northing");
  recipe::table(v, "sliding_surface", sliding_surface,
                "(5) how deep the surface lies that is computed under the polygon: give one of the first three");
}

void CoregistrationOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "mode", mode, {{"check", Alignment::check}, {"apply", Alignment::apply}, {"off", Alignment::off}},
                 "bring after_dem onto before_dem where nothing moved: check = find shift, height and tilt, and warn; "
                 "apply = correct them");
  v.flag("tilt", tilt, "look for a tilt too; one within its error is left out");
  v.number("steepest_deg", steepest, recipe::Range{0, 90, true, false}, "steeper ground is left out of the fit");
  v.path("changed", changed,
         "polygons of ground to leave out of the fit, besides source and deposit; changes that stand out are found by "
         "themselves");
}

void DifferenceOptions::describe(recipe::Visitor& v) {
  recipe::choice(v, "threshold", threshold,
                 {{"probabilistic", Threshold::probabilistic},
                  {"propagated-error", Threshold::propagated_error},
                  {"minimum-level", Threshold::minimum_level}},
                 "level of detection: confidence times the error; the error itself; or minimum_level_m alone");
  v.number("confidence", confidence, recipe::Range{0.5, 0.9999}, "of the probabilistic level, two-sided");
  v.number("minimum_level_m", minimum_level, recipe::not_negative, "the least level of detection in any case");
  v.number("before_sigma_m", before_sigma, recipe::not_negative,
           "standard error of before_dem; 0 for both = the difference's, by slope, from stable ground");
  v.number("after_sigma_m", after_sigma, recipe::not_negative, "that of after_dem");
}

double DifferenceOptions::given_sigma() const { return std::hypot(before_sigma, after_sigma); }

void DepositOptions::describe(recipe::Visitor& v) {
  v.path("polygon", polygon,
         "outline of the surveyed deposit; empty = what rose in the region of change that holds the source");
  v.number("threshold_m", threshold, recipe::not_negative,
           "rise beyond which (and beyond the level of detection) a cell belongs to it");
}

void GridOptions::describe(recipe::Visitor& v) {
  v.number("spacing_m", spacing, recipe::not_negative,
           "horizontal spacing h of the grid; 0 = the cell of the first DEM");
  v.number("layer_height_m", layer_height, recipe::not_negative,
           "vertical spacing h_z of the grid; 0 = the horizontal one");
  v.integers("points_per_cell", points_per_cell, recipe::Range{1, 64}, "material points along x, y and height");
  v.number("minimum_thickness_m", minimum_thickness, recipe::not_negative,
           "columns thinner than this get one point (of the same volume) instead of points_per_cell");
  v.number("jitter", jitter, recipe::Range{0, 0.5}, "random shift of the points, as a part of their spacing");
  v.integer("jitter_seed", jitter_seed, recipe::not_negative, "seed of that shift");
  v.optional_number("west_m", west, recipe::any, "western edge of the working grid; none = where all DEMs overlap");
  v.optional_number("south_m", south, recipe::any, "southern edge");
  v.optional_number("east_m", east, recipe::any, "eastern edge");
  v.optional_number("north_m", north, recipe::any, "northern edge");
  recipe::choice(
      v, "edge_nodata", edge_nodata, {{"refuse", EdgeNodata::refuse}, {"outside", EdgeNodata::outside}},
      "cells without elevation that reach the edge of the grid: refuse them, or leave them outside the domain");
}

void VoidOptions::describe(recipe::Visitor& v) {
  v.flag("fill", fill, "fill voids inside the elevation models by natural neighbours; else they are refused by place");
  v.number("largest_m2", largest, recipe::not_negative, "area of the largest void that is filled");
  recipe::choice(
      v, "spikes", spikes, {{"ignore", Spikes::ignore}, {"report", Spikes::report}, {"remove", Spikes::remove}},
      "cells that stand out from their neighbours (ten times the usual around): remove = make them voids and fill "
      "them");
}

void LaboratoryOptions::describe(recipe::Visitor& v) {
  v.integer("columns", columns, recipe::not_negative, "cells from west to east; 0 = no laboratory");
  v.integer("rows", rows, recipe::not_negative, "cells from south to north");
  v.number("west_m", west, recipe::any, "western edge");
  v.number("south_m", south, recipe::any, "southern edge");
  v.number("ground_m", ground, recipe::any, "elevation of the ground at the south-western corner");
  v.number("slope_x", slope_x, recipe::any, "rise of the ground per metre towards the east");
  v.number("slope_y", slope_y, recipe::any, "rise of the ground per metre towards the north");
}

void BoxOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of this box; empty = box-1, box-2, ...");
  v.number("west_m", west, recipe::any, "western side");
  v.number("east_m", east, recipe::any, "eastern side; a multiple of the points' spacing away");
  v.number("south_m", south, recipe::any, "southern side");
  v.number("north_m", north, recipe::any, "northern side");
  v.number("bottom_m", bottom, recipe::not_negative, "lower side, above the ground");
  v.number("top_m", top, recipe::not_negative, "upper side, above the ground");
}

void ObstacleOptions::describe(recipe::Visitor& v) {
  v.text("name", name, "name of the obstacle, as in [[solve.obstacle]]");
  v.path("polygons", polygons, "vector file of footprints");
  v.text("attribute", attribute, "the polygons' attribute that holds their height above the ground [m]");
  v.number("height_m", height, recipe::not_negative, "one height for all of them; 0 = that of the attribute");
  v.number("voxel_m", voxel, recipe::not_negative,
           "voxels of obstacles.vdb: the smallest given counts; 0 = a quarter of the smaller of spacing_m and "
           "layer_height_m");
}

void BedRasters::describe(recipe::Visitor& v) {
  for (auto& [name, file] : files)
    v.path(name, file, "raster that takes the place of [solve.base] " + name + "; no data: that number");
}

namespace {

/// For one of the models, where it differs from the others.
void describe_unit(recipe::Visitor& v, const char* key, VerticalUnit& unit, const char* help) {
  recipe::choice(v, key, unit,
                 {{"same", VerticalUnit::same},
                  {"declared", VerticalUnit::declared},
                  {"metre", VerticalUnit::metre},
                  {"foot", VerticalUnit::foot},
                  {"us-survey-foot", VerticalUnit::us_survey_foot}},
                 help);
}

}  // namespace

void Options::describe(recipe::Visitor& v) {
  v.path("before_dem", before_dem,
         "surface before the slide (1: with after_dem, 2: with sliding_surface, 5: with source.polygon alone)");
  v.path("after_dem", after_dem, "surface after it; only the lowering inside the source is taken out");
  v.path("sliding_surface", sliding_surface, "surface it slides on; no data = no sliding surface there");
  v.path("base_dem", base_dem, "ground under the releases (3: with [[preprocess.release]])");
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
  describe_unit(
      v, "before_vertical_unit", before_vertical_unit,
      "what the heights of before_dem are in, where it differs from the others; same = as vertical_unit says");
  describe_unit(v, "after_vertical_unit", after_vertical_unit,
                "what the heights of after_dem are in, where it differs from the others; same = as vertical_unit says");
  recipe::table(v, "coregistration", coregistration, "for (1): after_dem brought onto before_dem");
  recipe::table(v, "difference", difference, "for (1): after_dem less before_dem, and from where on it is believed");
  recipe::table(v, "deposit", deposit, "for (1): what arrived, written for the score");
  recipe::table(v, "source", source, "what fails, for (1), (2) and (5)");
  recipe::table(v, "grid", grid, "background grid and material points");
  recipe::table(v, "voids", voids, "cells without elevation inside the elevation models, and cells that stand out");
  recipe::list(v, "release", release, "what is released onto base_dem; may be repeated");
  recipe::list(
      v, "erodible", erodible,
      "a layer of ground that the slide can take along: material points with a strength of their own; may be repeated");
  recipe::table(v, "laboratory", laboratory, "(4) a plane instead of elevation models, with [[preprocess.box]]");
  recipe::list(v, "box", box, "a block of material on or above that plane; may be repeated");
  recipe::list(
      v, "obstacle", obstacle,
      "a body in the way, from polygons: written into OUT/obstacles.vdb for [[solve.obstacle]]; may be repeated");
  recipe::table(v, "bed", bed, "friction of the bed from place to place");
}

namespace {

Fault fault(std::string what, std::string why, std::string mend) {
  return {"[preprocess]: " + std::move(what), std::move(why), std::move(mend)};
}

void check_way(const Options& o, std::vector<Fault>& faults) {
  const std::string mend =
      "Give exactly one of: before_dem and after_dem; before_dem and sliding_surface; before_dem and source.polygon; "
      "base_dem and [[preprocess.release]]; [preprocess.laboratory] and [[preprocess.box]]";
  const bool before = !o.before_dem.empty(), after = !o.after_dem.empty(), sliding = !o.sliding_surface.empty();
  const bool base = !o.base_dem.empty(), releases = !o.release.empty();
  if (!before && !base) {
    faults.push_back(fault("neither before_dem nor base_dem is given", "nothing says what fails", mend));
  } else if (before && base) {
    faults.push_back(fault("before_dem and base_dem are both given", "they belong to different ways", mend));
  } else if (before && after == sliding && (after || o.source.polygon.empty())) {
    faults.push_back(fault(after ? "after_dem and sliding_surface are both given" : "before_dem stands alone",
                           "nothing says clearly what lies under the failing mass", mend));
  } else if (before && releases) {
    faults.push_back(
        fault("before_dem and [[preprocess.release]] are both given", "they belong to different ways", mend));
  } else if (base && (after || sliding)) {
    faults.push_back(fault("base_dem goes with releases only, but after_dem or sliding_surface is given",
                           "they belong to different ways", mend));
  } else if (base && !releases) {
    faults.push_back(fault("base_dem is given without a release", "nothing would move", mend));
  }
}

void check_release(const char* kind, const ReleaseOptions& r, std::size_t item, std::vector<Fault>& faults) {
  const std::string place = fmt::format("{} {}", kind, item + 1);
  if (r.thickness_raster.empty() == r.polygons.empty()) {
    faults.push_back(fault(place + (r.polygons.empty() ? ": neither thickness_raster nor polygons is given"
                                                       : ": thickness_raster and polygons are both given"),
                           "a release is one or the other",
                           "Give one; several releases are several [[preprocess.release]]"));
  }
  if (!r.thickness_raster.empty() && r.thickness > 0) {
    faults.push_back(fault(fmt::format("{}: thickness_m = {} beside thickness_raster", place, r.thickness),
                           "the raster holds the thickness", "Leave one out"));
  }
  if (!r.polygons.empty() && r.thickness == 0 && r.attribute.empty()) {
    faults.push_back(fault(place + ": polygons without thickness", "attribute is empty and thickness_m is 0",
                           "Name the attribute that holds the thickness, or give thickness_m"));
  }
}

void check_depth(const Options& o, std::vector<Fault>& faults) {
  const SlidingSurfaceOptions& s = o.source.sliding_surface;
  if (s.ways_given() > 1) {
    faults.push_back(fault("source.sliding_surface: more than one of depth_m, volume_m3 and depth_points is given",
                           "each says by itself how deep the surface lies", "Leave the others out"));
  }
  if (s.depth_points.empty() && (s.depth_points_error > 0 || s.depth_points_hold != PointValue::elevation)) {
    faults.push_back(
        fault("source.sliding_surface: depth_points_hold or depth_points_error_m is given without depth_points",
              "there are no points to read", "Give depth_points"));
  }
  if (s.ways_given() > 0 && (o.before_dem.empty() || !o.after_dem.empty() || !o.sliding_surface.empty())) {
    faults.push_back(fault("source.sliding_surface is given, but not before_dem and source.polygon alone",
                           "only there is a sliding surface computed; elsewhere the files hold it",
                           "Leave it out, or leave after_dem, sliding_surface and base_dem out"));
  }
}

void check_grid(const GridOptions& g, std::vector<Fault>& faults) {
  if (!(g.spacing >= 0) || !std::isfinite(g.spacing)) {
    faults.push_back(fault(fmt::format("grid.spacing_m = {}", g.spacing), "it must be positive",
                           "Give a length in metres, or 0 for the cell of the first DEM"));
  }
  if (!(g.layer_height >= 0) || !std::isfinite(g.layer_height)) {
    faults.push_back(fault(fmt::format("grid.layer_height_m = {}", g.layer_height), "it must be positive",
                           "Give a length in metres, or 0 for the horizontal spacing"));
  }
  bool three_positive = g.points_per_cell.size() == 3;
  for (int n : g.points_per_cell) three_positive = three_positive && n > 0;
  if (!three_positive) {
    faults.push_back(fault(fmt::format("grid.points_per_cell = [{}]", fmt::join(g.points_per_cell, ", ")),
                           "it must be three positive integers: along x, y and height", "The usual is [2, 2, 2]"));
  }
  if (g.west && g.east && *g.west >= *g.east) {
    faults.push_back(fault(fmt::format("grid.west_m = {}, east_m = {}", *g.west, *g.east), "west must lie west of east",
                           "Swap them"));
  }
  if (g.south && g.north && *g.south >= *g.north) {
    faults.push_back(fault(fmt::format("grid.south_m = {}, north_m = {}", *g.south, *g.north),
                           "south must lie south of north", "Swap them"));
  }
}

}  // namespace

namespace {

/// Tables that speak of two elevation models, where there is one.
void check_comparison(const Options& o, std::vector<Fault>& faults) {
  if (!o.after_dem.empty()) return;
  const auto refuse = [&](bool given, const char* what) {
    if (given)
      faults.push_back(fault(std::string(what) + " is given without after_dem", "it speaks of a second elevation model",
                             "Give after_dem, or leave it out"));
  };
  refuse(o.coregistration.mode == Alignment::apply, "coregistration.mode = \"apply\"");
  refuse(!o.coregistration.changed.empty(), "coregistration.changed");
  refuse(o.difference.given_sigma() > 0 || o.difference.minimum_level > 0,
         "an error or level in [preprocess.difference]");
  refuse(!o.deposit.polygon.empty(), "deposit.polygon");
}

}  // namespace

namespace {

/// Units of models that are not there.
void check_units(const Options& o, std::vector<Fault>& faults) {
  const auto refuse = [&](VerticalUnit unit, const std::filesystem::path& dem, const std::string& name) {
    if (unit == VerticalUnit::same || !dem.empty()) return;
    faults.push_back(fault(name + "_vertical_unit is given without " + name + "_dem",
                           "there are no heights that it speaks of",
                           "Leave it out, or use vertical_unit, which is for all elevation models"));
  };
  refuse(o.before_vertical_unit, o.before_dem, "before");
  refuse(o.after_vertical_unit, o.after_dem, "after");
}

}  // namespace

void Options::check(std::vector<Fault>& faults) const {
  std::set<std::string> bodies;
  for (std::size_t i = 0; i < obstacle.size(); ++i) {
    const std::string place = fmt::format("obstacle {}", i + 1);
    if (obstacle[i].polygons.empty())
      faults.push_back(fault(place + ": polygons is not given", "its footprint is not known", "Name a vector file"));
    if (obstacle[i].name.empty() || !bodies.insert(obstacle[i].name).second) {
      faults.push_back(fault(
          fmt::format("{}: name = \"{}\" is {}", place, obstacle[i].name, obstacle[i].name.empty() ? "empty" : "taken"),
          "[[solve.obstacle]] finds it by name", "Give it a name of its own"));
    }
  }
  if (laboratory.given() || !box.empty()) {
    if (!erodible.empty())
      faults.push_back(fault("erodible does not go with a laboratory", "its boxes are not read from maps",
                             "Give the layer as a box"));
    check_grid(grid, faults);
    if (faults.empty()) check_laboratory(*this, faults);
    return;
  }
  check_way(*this, faults);
  check_units(*this, faults);
  std::set<std::string> names;
  const auto check_list = [&](const char* kind, const auto& list, const auto& given_otherwise) {
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!given_otherwise(list[i])) check_release(kind, list[i], i, faults);
      if (!list[i].name.empty() && !names.insert(list[i].name).second) {
        faults.push_back(fault(fmt::format("{} {}: name \"{}\" is taken", kind, i + 1, list[i].name),
                               "results are told apart by name", "Name it otherwise"));
      }
    }
  };
  check_list("release", release, [](const ReleaseOptions&) { return false; });
  check_list("erodible", erodible, [&](const ErodibleOptions& e) {
    if (e.lowering && (after_dem.empty() || !e.thickness_raster.empty() || !e.polygons.empty())) {
      faults.push_back(fault("erodible: lowering = true beside a raster or polygons, or without after_dem",
                             "the layer is the difference of two elevation models",
                             "Give before_dem and after_dem and nothing else, or leave lowering out"));
    }
    return e.lowering;
  });
  check_grid(grid, faults);
  check_comparison(*this, faults);
  if (voids.spikes == Spikes::remove && !voids.fill) {
    faults.push_back(fault("voids.spikes = \"remove\" without voids.fill", "what is removed is filled like a void",
                           "Set fill = true in [preprocess.voids], or spikes = \"report\""));
  }
  if (source.seed_x.has_value() != source.seed_y.has_value()) {
    faults.push_back(
        fault("only one of source.seed_x_m and seed_y_m is given", "a point has both", "Give both or none"));
  }
  if (source.seed_x && !source.polygon.empty()) {
    faults.push_back(fault("source.polygon and a seed point are both given",
                           "the polygon already says what the source is", "Leave one out"));
  }
  check_depth(*this, faults);
  if (!base_dem.empty() && !source.polygon.empty()) {
    faults.push_back(fault("source.polygon is given with base_dem", "the releases say what fails there",
                           "Use polygons = ... in [[preprocess.release]]"));
  }
}

Way Options::way() const {
  if (laboratory.given()) return Way::laboratory;
  if (!base_dem.empty()) return Way::base_and_releases;
  if (!after_dem.empty()) return Way::before_and_after;
  return sliding_surface.empty() ? Way::before_and_outline : Way::before_and_sliding_surface;
}

}  // namespace talus::preprocess
