// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Table [postprocess] of a recipe.
#pragma once

#include <algorithm>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "common/ensemble/fit_options.hpp"
#include "common/error.hpp"
#include "common/recipe/recipe.hpp"
#include "postprocess/options/writer.hpp"

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

  /// Whether it gives more than an outline.
  bool measures() const { return !(thickness.empty() && difference.empty() && after_dem.empty()); }
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
    for (const auto& file : {difference, sigma})
      if (!file.empty() && !std::filesystem::exists(file))
        throw DataError({file.string() + ": no such file",
                         "[postprocess.survey] from_preprocess = true, and talus-preprocess writes it where before_dem "
                         "and after_dem are given",
                         "Run talus-preprocess with the same --out, or name the survey otherwise"});
  }
  bool given() const { return measures() || !peak_thickness.empty() || !polygon.empty(); }
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
    std::vector<const char*> keys;
    for (const auto& [given, key] : deposits)
      if (given) keys.push_back(key);
    v.needs(keys.size() <= 1, {fmt::format("[postprocess.survey] gives {}", fmt::join(keys, " and ")),
                               "one deposit can be scored at a time", "Leave one of them out"});
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

/// True if lower limits of classes rise.
inline bool rise(const std::vector<double>& limits) {
  return std::adjacent_find(limits.begin(), limits.end(), std::greater_equal<>()) == limits.end();
}

/// Declares that the limits of classes rise, and that a map can show so many; `key`: of the limits, with its table.
inline void need_classes(recipe::Visitor& v, const std::string& key, const std::vector<double>& limits) {
  v.needs(rise(limits),
          {key + " does not rise", "classes are given by their lower limits", "Sort the limits, each once"});
  v.needs(limits.size() <= 9, {fmt::format("{} has {} classes", key, limits.size()),
                               "nobody tells more than 9 shades apart on a map", "Give 9 limits or fewer"});
}

/// By whose limits intensity is told apart (postprocess/hazard/hazard.cpp).
enum class Guideline {
  none,
  swiss_debris_flow,
  swiss_flood,
  swiss_avalanche,
  debris_flow_concrete,
  debris_flow_other,
  own
};

/// Whether one of the quantities is enough for a class, or all are needed.
enum class Rule { any, all };

/// The keys of [postprocess.intensity].
struct IntensityOptions {
  Guideline guideline = Guideline::none;
  std::vector<double> thickness{}, speed{}, thickness_speed{}, pressure{};  ///< own limits [m], [m/s], [m2/s], [kPa]
  Rule rule = Rule::any;
  void describe(recipe::Visitor& v) {
    recipe::choice(v, "guideline", guideline,
                   {{"none", Guideline::none},
                    {"swiss-debris-flow", Guideline::swiss_debris_flow},
                    {"swiss-flood", Guideline::swiss_flood},
                    {"swiss-avalanche", Guideline::swiss_avalanche},
                    {"debris-flow-concrete", Guideline::debris_flow_concrete},
                    {"debris-flow-other", Guideline::debris_flow_other},
                    {"own", Guideline::own}},
                   "whose limits make the classes of maps/intensity.tif; own: those below; none: no such map");
    v.numbers("thickness_m", thickness, recipe::positive,
              "own: peak thickness from which class 1, 2, ... begins; any of the quantities given is enough");
    v.numbers("speed_m_s", speed, recipe::positive, "own: the same of the peak speed");
    v.numbers("pressure_kPa", pressure, recipe::positive, "own: the same of the peak pressure");
    const std::pair<const char*, const std::vector<double>*> given[] = {
        {"thickness_m", &thickness}, {"speed_m_s", &speed}, {"pressure_kPa", &pressure}};
    std::size_t classes = 0;
    for (const auto& [key, limits] : given) classes = std::max(classes, limits->size());
    v.needs(guideline == Guideline::own || classes == 0,
            {"[postprocess.intensity] gives limits, but guideline is not \"own\"", "a guideline brings its own limits",
             "Leave them out, or take guideline = \"own\""});
    v.needs(guideline != Guideline::own || classes > 0,
            {"[postprocess.intensity] guideline = \"own\" without limits", "there would be no class",
             "Give thickness_m, speed_m_s or pressure_kPa"});
    for (const auto& [key, limits] : given) {
      v.needs(
          limits->empty() || limits->size() == classes,
          {fmt::format("[postprocess.intensity] {} has {} limits, another quantity {}", key, limits->size(), classes),
           "every quantity says where each class begins", "Give as many limits for each"});
      need_classes(v, fmt::format("[postprocess.intensity] {}", key), *limits);
    }
  }
};

/// The keys of [postprocess.reach_cone].
struct ReachConeOptions {
  std::optional<double> angle{};  ///< of the cone below the horizontal [deg]
  bool by_volume = false;         ///< cones by the published regressions of H/L over volume too
  bool asked() const { return angle || by_volume; }
  void describe(recipe::Visitor& v) {
    v.optional_number("angle_deg", angle, recipe::Range{0, 90, true, true},
                      "angle of reach (Fahrboeschung) of maps/reach_cone.tif, below the horizontal");
    v.flag("by_volume", by_volume,
           "cones by the angles usual for the released volume as well (Scheidegger 1973, Corominas 1996)");
  }
};

/// The keys of [postprocess.buildings].
struct BuildingOptions {
  std::filesystem::path polygons{};
  double pressure_coefficient = 1;   ///< of the thrust over density times speed squared [-]
  std::string attribute = "height";  ///< of the polygons: height above the ground [m]
  void describe(recipe::Visitor& v) {
    v.path(
        "polygons", polygons,
        "footprints of buildings (any vector format): what comes to each, into buildings.csv and maps/buildings.gpkg");
    v.number("pressure_coefficient", pressure_coefficient, recipe::positive,
             "thrust over density times speed squared (1: Hungr et al. 1984)");
    v.text("attribute", attribute,
           "the polygons' attribute that holds their height above the ground [m], if they have it");
  }
};

/// By which map the intensity of a hazard goes.
enum class HazardIntensity { peak_pressure, peak_thickness, peak_speed };

/// Classes by how probable it is that a place is hit at least so hard (of an ensemble).
struct HazardOptions {
  HazardIntensity intensity = HazardIntensity::peak_pressure;
  std::vector<double> limits;                       // lower limits of its classes, rising; empty = the usual ones
  std::vector<double> probability{0.01, 0.1, 0.5};  // lower limits of its classes, rising
  std::vector<int> matrix{1, 1, 2, 1, 2, 3};        // class, row by row: intensity from weak, probability from rare

  void describe(recipe::Visitor& v) {
    recipe::choice(v, "intensity", intensity,
                   {{"peak-pressure", HazardIntensity::peak_pressure},
                    {"peak-thickness", HazardIntensity::peak_thickness},
                    {"peak-speed", HazardIntensity::peak_speed}},
                   "the map by which the intensity of a hazard goes");
    v.numbers("limits", limits, recipe::positive,
              "lower limits of the classes of intensity, rising, in kPa, m or m/s; they must be among those of "
              "[ensemble.thresholds]; empty: 3 30 kPa, 0.5 1 m, 0.5 1 m/s where they are");
    v.numbers("probability", probability, recipe::fraction, "lower limits of the classes of probability, rising");
    v.integers("matrix", matrix, {0, 9},
               "hazard class of each intensity (from weak) and probability (from rare), row by row; 0: none");
    v.needs(rise(limits) && rise(probability) && !probability.empty(),
            {"[postprocess.hazard] limits or probability do not rise", "classes are given by their lower limits",
             "Sort them, each once"});
    const std::size_t rows = limits.empty() ? 2 : limits.size();
    v.needs(matrix.size() == rows * probability.size(),
            {"[postprocess.hazard] matrix has " + std::to_string(matrix.size()) + " classes",
             std::to_string(rows) + " intensities and " + std::to_string(probability.size()) + " probabilities take " +
                 std::to_string(rows * probability.size()),
             "Give a class for each pair"});
  }
};

/// Where the friction of a run comes from, as its recipe says.
enum class FrictionIs { not_said, given, guessed, fitted };

/// The thresholds that the recipe gives [m]; empty: that of the run's maps.
struct GivenThresholds {
  std::optional<double> footprint_threshold{}, deposit_threshold{};
};

/// The keys of [postprocess].
struct Options {
  std::filesystem::path run;  // empty = OUT/run.h5
  GivenThresholds given;
  double footprint_threshold = 0.1, deposit_threshold = 0.1;  // [m], as settle_thresholds() leaves them
  std::vector<double> classes;  // lower limits of the thickness classes [m]; empty = by the deposit's thickness
  FrictionIs friction_is = FrictionIs::not_said;
  bool leaves_friction = false;  // no key: the recipe names none, so that the program's defaults act
  std::string institution;
  std::vector<std::string> outputs{"report", "report-3d", "surface", "terrain"};  // words of the writers
  std::string start_time;         // when the failure began, UTC; empty = not known
  std::filesystem::path thalweg;  // line along which run-out is measured; empty = found from the run
  SurveyOptions survey;
  IntensityOptions intensity;
  ReachConeOptions reach_cone;
  BuildingOptions buildings;
  HazardOptions hazard;
  CalibrateOptions calibrate;       // no keys: the recipe's [calibrate]
  std::vector<std::string> accept;  // what is refused as implausible, insisted on by name

  bool writes(std::string_view word) const;
  /// Takes the thresholds that the recipe leaves to the program from the run: `of_run` is that of its maps [m].
  void settle_thresholds(double of_run);
  void describe(recipe::Visitor& v);
};

}  // namespace talus::postprocess
