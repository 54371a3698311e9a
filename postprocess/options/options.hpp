// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Table [postprocess] of a recipe.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "postprocess/options/hazard.hpp"
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
  bool nodata_is_zero = false;                // thickness and difference rasters: no data means no deposit, no change
  std::filesystem::path sigma;                // raster of the standard error of thickness or change [m]
  double sigma_m = 0;                         // the same, one number for all cells [m]; 0 = not known
  double correlation_length = 0;              // range within which errors are alike [m]; 0 = as the sigma raster says
  double detection = 1.96;                    // level of detection over sigma
  int resamples = 200;                        // of the survey, within its error

  bool measures() const {
    return !(thickness.empty() && difference.empty() && after_dem.empty());
  }  ///< not an outline only
  /// Names the files under `out` where from_preprocess asks for them, whether they are there or not.
  void name_files(const std::filesystem::path& out);
  /// Names them likewise, without a sigma where talus-preprocess knows none. Throws DataError when they are not there.
  void find_in(const std::filesystem::path& out, bool error_known = true);
  bool given() const { return measures() || !peak_thickness.empty() || !polygon.empty(); }
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

/// By which map the intensity of a hazard goes.
enum class HazardIntensity { peak_pressure, peak_thickness, peak_speed };

/// Classes by how probable it is that a place is hit at least so hard (of an ensemble).
struct HazardOptions {
  HazardIntensity intensity = HazardIntensity::peak_pressure;
  std::vector<double> limits;                       // lower limits of its classes, rising; empty = the usual ones
  std::vector<double> probability{0.01, 0.1, 0.5};  // lower limits of its classes, rising
  std::vector<int> matrix{1, 1, 2, 1, 2, 3};        // class, row by row: intensity from weak, probability from rare

  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

/// The keys of [postprocess].
struct Options {
  std::filesystem::path run;         // empty = OUT/run.h5
  double footprint_threshold = 1.0;  // [m]
  double deposit_threshold = 1.0;    // [m]
  std::vector<double> classes;       // lower limits of the thickness classes [m]; empty = by the deposit's thickness
  std::string institution;
  std::vector<std::string> outputs{"report", "report-3d", "surface", "terrain"};  // words of the writers
  std::string start_time;         // when the failure began, UTC; empty = not known
  std::filesystem::path thalweg;  // line along which run-out is measured; empty = found from the run
  SurveyOptions survey;
  IntensityOptions intensity;
  ReachConeOptions reach_cone;
  BuildingOptions buildings;
  HazardOptions hazard;
  Writers writers;
  std::vector<std::string> accept;  // what is refused as implausible, insisted on by name

  /// True if `outputs` has the word.
  bool writes(std::string_view word) const;
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::postprocess
