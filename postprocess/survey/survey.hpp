// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The survey a run is scored against, and the one place where survey and simulation are brought to one grid.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/gis/declared_heights.hpp"
#include "common/map/polygon.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// What OUT/survey/survey.json says.
struct FoundSurvey {
  bool error_known = true;
  bool outside_is_large = false;     ///< much changed outside the slide, and nothing explains it
  bool outside_is_doubtful = false;  ///< much of what counts as noise lies within reach of the slide
  std::string outside_words = {};
  std::string id = {};           ///< of the domain that was prepared with it
  std::string recipe_mark = {};  ///< of the [preprocess] that made it
};

/// Reads it; what it does not say is as above. Throws DataError: no JSON, or alone missing.
FoundSurvey read_found_survey(const std::filesystem::path& out);

/// True where it says that the error is not known, so that there is no raster of it. Never throws.
bool lacks_error(const std::filesystem::path& out);

/// Refuses, unless accepted ("change-outside-slide"), a survey in which much changed outside the slide.
void judge_outside(const FoundSurvey& found, const std::filesystem::path& out);

/// How far a survey may be off.
struct SurveyError {
  std::vector<double> sigma;      ///< standard error of the measured value at each cell [m]; empty: not known
  double correlation_length = 0;  ///< range of a spherical correlation of the errors [m]; 0: cells are independent
  double detection = 0;           ///< level of detection over sigma; 0: off
  double noise = 0;               ///< level of detection where sigma is not known (noise_of) [m]

  /// The level of detection of a cell: what is less counts as none, in the survey and in the simulation [m].
  double level(std::size_t cell) const { return sigma.empty() ? noise : detection * sigma[cell]; }
  /// What is no noise on any of a million cells: five standard errors [m].
  double sure(std::size_t cell) const { return sigma.empty() ? noise : 5 * sigma[cell]; }
};

/// What texts call a reference: "the survey", "surveyed thickness"; of another model "the reference".
struct ReferenceWords {
  const char* noun;
  const char* adjective;
};

/// A survey on its own grid. Empty vectors: not given. NaN: not surveyed.
struct Survey {
  std::string name;
  ReferenceKind kind = ReferenceKind::survey;
  MapGrid grid;                  ///< the grid everything is compared on: the survey's, or the run's for a bare polygon
  std::vector<double> measured;  ///< thickness, or after - before, before any level of detection [m]
  SurveyError error;             ///< of `measured`
  std::vector<double> deposit;   ///< [m] thickness, or max(0, after - before)
  bool deposit_is_change = false;    ///< deposit is a change of the surface: compared with the simulated change
  std::vector<double> footprint;     ///< peak thickness or |change| [m], or 1 inside and 0 outside a polygon
  bool footprint_is_change = false;  ///< footprint is |after - before|
  double footprint_threshold = 0;    ///< footprint where above this
  std::vector<MapPolygon> polygons;
  std::vector<std::filesystem::path> inputs;
  std::vector<std::string> notes;  ///< what a reader of the scores should know of it
  /// The median level of detection of what was measured [m]; 0 where there is none.
  double usual_level() const;
  ReferenceWords words() const {
    return kind == ReferenceKind::model ? ReferenceWords{"reference", "reference"}
                                        : ReferenceWords{"survey", "surveyed"};
  }
};

/// What a survey takes for deposit, and for footprint where that is a change, when it measures `value` [m].
struct DetectedChange {
  std::vector<double> deposit, footprint;
};

/// Values below the level of detection count as 0; deposit is what is positive, footprint the size of the change.
DetectedChange detected(const Survey& survey, const std::vector<double>& value);

/// The level of detection of a survey whose error is not given [m]: five standard deviations of what it measured where
/// the run left the ground alone, so that no noise is taken for a slide. The median of |change| tells the deviation, or
/// of a thickness the lower quartile, for what is negative there can only be noise (-0.6745 deviations of a normal
/// distribution). At most 1 m: what is larger there is what the run lacks. 0 where the run left alone less than half of
/// the surveyed ground.
double noise_of(const Survey& survey, const RunMaps& maps);

/// The simulation on the survey's grid, without what the survey could not have detected; NaN where it has nothing to
/// compare with.
struct OnSurveyGrid {
  std::vector<double> deposit;  ///< final thickness, or max(0, final - initial thickness) for a surveyed change [m]
  std::vector<double> change;   ///< the same without the max(0, .): what `measured` would be [m]
  std::vector<double> peak;     ///< peak thickness [m]
  std::vector<double> touched;  ///< share of the cell whose peak thickness exceeds the footprint's threshold [-]
  std::vector<double> covered;  ///< share of it whose deposit exceeds its threshold [-]; of a change 1 or 0
  double deposit_left_out = 0;  ///< volume of simulated deposit on cells that were not surveyed [m3]
};

/// What the options name; empty if that is nothing. Throws DataError: unreadable, other CRS, no overlap with the run.
/// Judges the vertical datums of two surfaces, of which `ground` is the run's.
std::optional<Survey> read_survey(const SurveyOptions& options, const RunMaps& maps, double footprint_threshold,
                                  const DeclaredHeights& ground);

/// A cell of the survey counts as touched or covered where more than this share of it is.
inline constexpr double most_of_a_cell = 0.5;

/// Area-weighted, so that volume is kept; where the run's map ends but the survey goes on, nothing arrived: 0.
OnSurveyGrid bring_to_survey_grid(const RunMaps& maps, const Survey& survey, const Options& options = {});

/// Refuses, unless accepted ("swapped-surveys"), that a surveyed change would have carried mass uphill: what
/// rose by more than the footprint's threshold and the level of detection lies higher, on average by volume, than what
/// fell by as much, and is more than a tenth of it. A survey that is no change of the surface says nothing of this.
void judge_order(const Survey& survey, const RunMaps& maps);

/// True where cells coincide to a millionth of a cell.
bool same_grid(const MapGrid& a, const MapGrid& b);

/// A thickness on `grid`, by area weights where the grids differ.
std::vector<double> on_grid(const Raster& raster, const MapGrid& grid);

}  // namespace talus::postprocess
