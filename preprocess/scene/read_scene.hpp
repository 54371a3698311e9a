// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of a scene say, on one grid: the first part of prepare().
#pragma once

#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/map/raster.hpp"
#include "common/stage/findings.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/releases.hpp"
#include "preprocess/release/sliding_surface.hpp"
#include "preprocess/survey/survey.hpp"

namespace talus::preprocess {

/// Ground and release on the working grid, before anything is scaled, laid or seeded.
struct SceneRasters {
  Raster before, bed;
  std::vector<Release> releases;                       // of what fails; erodible layers come later
  std::vector<double> lowering = {};                   // before less after [m]; where both are given
  std::optional<SlidingSurface> sliding_surface = {};  // where it was computed
  std::optional<Survey> survey = {};
  std::optional<SurveyedSlide> slide = {};
  std::vector<Finding> findings = {};
  DeclaredHeights heights = {};  // of `before`
};

/// The options with working_crs = "utm" replaced by the zone of the centre of the first DEM. Throws RecipeError.
Options resolved(Options options);

/// What before_dem and after_dem say of what changed, and nothing further: the first part of read_scene().
Survey survey_of(const Options& options);

/// Two surveys compared and aligned, before anything is said to fail.
struct Surveyed {
  Survey survey;
  std::vector<Raster> surfaces;        // before and after, on the working grid
  std::optional<SurveyedSlide> slide;  // its errors and what was filled; never empty
  std::vector<Finding> findings = {};
};

/// Keeps the first survey that was compared, for scenes that differ in what they make of it, and the place of the slide
/// that was found in it: all scenes of an ensemble are of one slide. For several threads.
class SurveyMemory {
 public:
  /// What `options` ask for, compared anew where it is another survey than the first.
  Surveyed surveyed(const Options& options);
  /// The place that the first call found, [easting, northing]; `find` is called where none did.
  template <class Find>
  std::vector<double> place(const Find& find) {
    const std::lock_guard lock(mutex_);
    if (place_.empty()) place_ = find();
    return place_;
  }

 private:
  static std::string mark_of(Options options);
  std::mutex mutex_;
  std::string mark_;
  std::unique_ptr<const Surveyed> kept_;
  std::vector<double> place_;
};

/// Reads the files, aligns them, finds or reads the release. `memory`, where given, spares the comparison of the same
/// surveys. Throws RecipeError and DataError.
SceneRasters read_scene(const Options& options, SurveyMemory* memory = nullptr);

}  // namespace talus::preprocess
