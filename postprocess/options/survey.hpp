// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a run is scored against.
#pragma once

#include <filesystem>
#include <string>
#include <utility>

#include "common/error.hpp"
#include "common/recipe/recipe.hpp"

namespace talus::postprocess {

/// Which way the survey's rasters measure thickness.
enum class Direction { vertical, slope_normal };

/// What the simulation is compared with: what was surveyed, or the run of another model.
enum class ReferenceKind { survey, model };

/// What the simulation is scored against. Nothing given: no score against a survey.
struct SurveyOptions {
  std::string name = "survey";  // how the map and the table call it
  ReferenceKind kind = ReferenceKind::survey;
  std::filesystem::path thickness;       // raster of deposit thickness, vertical [m]
  std::filesystem::path peak_thickness;  // raster of peak thickness, vertical [m]: the footprint
  std::filesystem::path before_dem;      // with after_dem: surveyed change; empty = the run's own surface before
  std::filesystem::path after_dem;
  std::filesystem::path difference;           // raster of after - before, aligned [m]
  bool from_preprocess = false;               // difference and sigma are what talus-preprocess wrote into OUT/survey
  std::filesystem::path polygon;              // outline of the affected area
  Direction direction = Direction::vertical;  // of thickness and peak_thickness
  std::filesystem::path sigma;                // raster of the standard error of thickness or change [m]
  double sigma_m = 0;                         // the same, one number for all cells [m]; 0 = not known
  double correlation_length = 0;              // range within which errors are alike [m]; 0 = as the sigma raster says
  int resamples = 200;                        // of the survey, within its error; no key

  bool measures() const {
    return !(thickness.empty() && difference.empty() && after_dem.empty());
  }  ///< not an outline only
  /// Names the files under `out` where from_preprocess asks for them, whether they are there or not.
  void name_files(const std::filesystem::path& out) {
    if (!from_preprocess) return;
    difference = out / "survey" / "slide_difference.tif";
    sigma = out / "survey" / "difference_sigma.tif";
  }
  /// Names them likewise, without a sigma where talus-preprocess knows none. Throws DataError when they are not there.
  void find_in(const std::filesystem::path& out, bool error_known = true) {
    name_files(out);
    if (!from_preprocess) return;
    if (!error_known) sigma.clear();
    for (const auto& file : {difference, sigma}) {
      if (!file.empty() && !std::filesystem::exists(file))
        throw DataError({file.string() + ": no such file",
                         "[postprocess.survey] from_preprocess = true, and talus-preprocess writes it where before_dem "
                         "and after_dem are given",
                         "Run talus-preprocess with the same --out, or name the survey otherwise"});
    }
  }
  bool given() const { return measures() || !peak_thickness.empty() || !polygon.empty(); }
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v) {
    v.text("name", name, "how map and table call it: a survey, or another model's name");
    recipe::choice(
        v, "kind", kind, {{"survey", ReferenceKind::survey}, {"model", ReferenceKind::model}},
        "what it is: a survey, or the run of another model, which report and table then do not call surveyed");
    v.needs(kind == ReferenceKind::survey || name != "survey",
            {"[postprocess.survey] gives kind = \"model\" without a name", "maps and tables would call it a survey",
             "Name the other model: name = \"SHALTOP, 15 degrees\""});
    v.path("thickness", thickness, "raster of the deposit's thickness [m]");
    v.path("peak_thickness", peak_thickness, "raster of the peak thickness [m]; gives the footprint");
    recipe::choice(v, "direction", direction,
                   {{"vertical", Direction::vertical}, {"slope-normal", Direction::slope_normal}},
                   "which way these two measure thickness; slope-normal: brought to vertical with the run's ground");
    v.path("after_dem", after_dem, "elevations after the event: deposit where they lie above those before");
    v.path("before_dem", before_dem,
           "elevations before the event, with after_dem; empty: the surface the run started from");
    v.needs(before_dem.empty() || !after_dem.empty(),
            {"[postprocess.survey] gives before_dem alone", "a change needs two surfaces", "Give after_dem as well"});
    v.path("difference", difference,
           "raster of elevations after - before the event [m], aligned: deposit where it is positive");
    v.flag("from_preprocess", from_preprocess,
           "score against the change of surface that talus-preprocess found between before_dem and after_dem, with its "
           "error (OUT/survey)");
    need_one_deposit(v);
    v.path("polygon", polygon, "outline of the affected area (any vector format); gives the footprint");
    v.needs(peak_thickness.empty() || polygon.empty(), {"[postprocess.survey] gives peak_thickness and polygon",
                                                        "both say what the footprint is", "Leave one of them out"});
    v.needs(
        kind == ReferenceKind::survey || (sigma.empty() && !(sigma_m > 0) && !from_preprocess),
        {"[postprocess.survey] gives kind = \"model\" and the error of a survey",
         "what another model computed has no error of measurement", "Leave sigma and from_preprocess out, or kind"});
    v.path("sigma", sigma,
           "raster of the standard error (1 sigma) of thickness or change [m]; what is below 1.96 sigma (95 %) counts "
           "as none");
    v.number("sigma_m", sigma_m, recipe::not_negative,
             "the same error for all cells, instead of a raster; 0: not known");
    need_one_error(v);
    v.number(
        "correlation_length_m", correlation_length, recipe::not_negative,
        "distance within which errors are alike (range of a spherical variogram); 0: CORRELATION_LENGTH_M of the sigma "
        "raster, else every cell for itself");
  }

 private:
  /// Declares that the survey gives one deposit at most.
  void need_one_deposit(recipe::Visitor& v) const {
    const std::pair<bool, const char*> deposits[] = {{!thickness.empty(), "thickness"},
                                                     {!difference.empty(), "difference"},
                                                     {!after_dem.empty(), "after_dem"},
                                                     {from_preprocess, "from_preprocess"}};
    std::string keys;
    int count = 0;
    for (const auto& [given, key] : deposits) {
      if (given) keys += (count++ > 0 ? " and " : "") + std::string(key);
    }
    v.needs(count <= 1,
            {"[postprocess.survey] gives " + keys, "one deposit can be scored at a time", "Leave one of them out"});
  }
  /// Declares that the survey gives one error at most.
  void need_one_error(recipe::Visitor& v) const {
    const bool given = !sigma.empty() || sigma_m > 0;
    v.needs(sigma.empty() || !(sigma_m > 0), {"[postprocess.survey] gives sigma and sigma_m",
                                              "both say what the survey's error is", "Leave one of them out"});
    v.needs(!given || !from_preprocess, {"[postprocess.survey] gives from_preprocess and an error",
                                         "the error comes with the change that talus-preprocess found",
                                         "Leave sigma out; [preprocess.difference] takes the surveys' own"});
    v.needs(!given || from_preprocess || measures(),
            {"[postprocess.survey] gives an error without a measurement", "an outline or a peak thickness has none",
             "Give thickness, difference or after_dem, or leave sigma out"});
  }
};

}  // namespace talus::postprocess
