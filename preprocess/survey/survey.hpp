// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Two elevation models as one survey of what changed: aligned, compared, with the error of the comparison.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/stage/identity.hpp"
#include "preprocess/survey/change.hpp"
#include "preprocess/survey/coregistration.hpp"
#include "preprocess/survey/difference.hpp"
#include "preprocess/terrain/voids.hpp"

namespace talus::preprocess {

/// Two elevation models with what their comparison found.
struct Survey {
  Elevation before, after;  // the later one placed, where that was asked for
  MapGrid grid;             // what both cover, in cells of the first
  Coregistration fit;
  bool applied = false;
  ErrorModel errors;
  std::vector<MapPolygon> source, deposit;                    // outlines, where the recipe gives them
  std::vector<MapPolygon> ignored;                            // ground whose change is not looked at
  std::vector<std::pair<MapGrid, std::vector<char>>> stable;  // of each patch that was looked at
};

/// Finds how the later survey lies on the earlier one, corrects it where the options say so, and learns the error of
/// their difference from stable ground. Throws DataError where an alignment is asked for and there is no stable ground
/// to find it on, where the surveys do not overlap, where one looks like feet, and where an outline is not valid.
Survey compare_surveys(Elevation before, Elevation after, const Options& options);

/// What a Survey says, as people read it.
std::vector<std::string> as_lines(const Survey& survey);

struct SurveyedVolume {
  std::string name;
  VolumeWithError volume;
};

/// What is known of the slide on the working grid.
struct SurveyedSlide {
  Raster deposit;  // rise of the surface in the deposit, 0 outside, NaN where not surveyed [m]
  Raster
      change;  // after less before in the slide, where it is believed; 0 outside, NaN where not surveyed or filled [m]
  Raster sigma;                    // standard error of the difference, that of filled voids taken in [m]
  std::vector<double> fill_error;  // of what was filled alone, as much of sigma [m]; empty where nothing was
  Raster filled;  // 1 where the survey before was filled, 2 the one after, 3 both, else 0; no values where none was
  std::vector<SurveyedVolume> volumes;
  ChangeOutside outside = {};     // what changed elsewhere
  bool outside_is_large = false;  // and is not explained: beside source and deposit, by itself, or by a given outline
  Near near = {};                 // what counts as noise though it lies within reach of the slide
  bool outside_is_doubtful = false;  // that is much
  std::vector<char> ignored = {};    // cells whose change is not looked at; empty where all is
};

/// Standard error of every cell of a surface, and what was filled (in the order of the two surveys; empty = nothing);
/// the rest is left to delineate().
SurveyedSlide slide_on(const Survey& survey, const Raster& before, const std::vector<Filled>& filled);

/// What changed outside the slide, in words.
std::string outside_words(const SurveyedSlide& slide);

/// Level of detection of every cell.
std::vector<double> levels_of(const Raster& sigma);

/// After less before, with what of it is believed: nothing on ignored ground, whose levels are infinite.
Change change_between(const Raster& before, const Raster& after, const DepositOptions& given,
                      const SurveyedSlide& slide);

/// Both surfaces, and the source's thickness on the same cells.
struct SlideSurfaces {
  const Raster &before, &after, &source;
};

/// The deposit: within its polygon; else what rose beyond threshold and level of detection in the slide as
/// sure_regions() and grown_slide() find it, which may be nothing. Volumes of source and deposit with their errors: of
/// the surveys, of what was filled, and of where the edge is drawn; and what changed outside the slide.
void delineate(const Survey& survey, const SlideSurfaces& surfaces, const DepositOptions& given, SurveyedSlide& slide);

/// Alignment, error, variogram and volumes as JSON; keys carry their unit (docs/reference/formats.md). `marks` are
/// those of the preparation (identity.hpp).
std::string survey_json(const Survey& survey, const Budgets& budgets, const std::optional<SurveyedSlide>& slide,
                        const Facts& marks = {});

}  // namespace talus::preprocess
