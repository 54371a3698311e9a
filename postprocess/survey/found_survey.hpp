// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What talus-preprocess says of the survey that it leaves for the score.
#pragma once

#include <filesystem>
#include <string>

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

/// Reads it; what it does not say is as above. Throws DataError where it is no JSON.
FoundSurvey read_found_survey(const std::filesystem::path& out);

/// True where it says that the error is not known, so that there is no raster of it. Never throws.
bool lacks_error(const std::filesystem::path& out);

/// Refuses, unless accepted ("change-outside-slide"), a survey in which much changed outside the slide: the deposit,
/// and with it every score, would lack it.
void judge_outside(const FoundSurvey& found, const std::filesystem::path& out);

/// Refuses (DataError) a survey that talus-preprocess did not come to the end of.
void require_whole_survey(const std::filesystem::path& out);

}  // namespace talus::postprocess
