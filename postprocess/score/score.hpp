// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a run, and how well it agrees with a survey.
// What footprint, deposit and run-out are, add_definitions() says (agreement_section.cpp), which puts it under
// score.txt; single scores are defined with the functions that compute them.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/mobility.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

struct Hazard;

struct ScoreEntry {
  std::string key;    ///< as in score.json, with unit
  std::string label;  ///< as in score.txt
  std::string unit;
  std::variant<double, std::int64_t, std::string> value;
  int decimals = 0;  ///< in score.txt
};

/// Entries under one heading.
struct ScoreSection {
  std::string title;
  std::vector<ScoreEntry> entries;
};

/// All entries, in sections, with what could not be scored and why.
struct Score {
  std::string title;
  std::vector<std::string> belief;  ///< what may be believed (belief.hpp)
  std::vector<ScoreSection> sections;
  std::vector<std::pair<std::string, std::string>> not_scored;  ///< key, why it has no value
  std::vector<std::string> notes;                               ///< definitions
  std::vector<Finding> findings;                                ///< of all stages

  /// The number under a key; empty where it is absent.
  std::optional<double> number(const std::string& key) const;
};

/// Scores a run, against the survey where there is one, with what an authority asks where that was computed.
Score make_score(const Run& run, const Options& options, const std::optional<Survey>& survey, const Thalweg& thalweg,
                 const Hazard* hazard = nullptr);

/// Warns of a run that ended while more than a hundredth of its volume moved, or of its largest kinetic energy was
/// left.
void warn_of_end(const Run& run);

/// One flat object: key -> value; `not_scored` says why a value is absent; `findings` is an array of objects.
std::string to_json(const Score& score);

/// Of a score what a run is first judged by: what may be believed, and six numbers (released volume, run-out, H/L,
/// largest speed, thickest deposit, overlap of the deposits). `rest`: the file that holds all.
Score headline_of(const Score& score, const std::filesystem::path& rest);

/// A score as an aligned table with the findings and the definitions below it.
std::string to_table(const Score& score);

/// Collects entries in sections; a number that is not finite goes to not_scored with the reason given.
class Sheet {
 public:
  explicit Sheet(std::string title) { score_.title = std::move(title); }

  void section(std::string title) { score_.sections.push_back({std::move(title), {}}); }  ///< begins a section
  /// Adds a word to the last section.
  void text(std::string key, std::string label, std::string value) {
    score_.sections.back().entries.push_back({std::move(key), std::move(label), "", std::move(value), 0});
  }
  /// Adds a whole number to the last section.
  void count(std::string key, std::string label, std::int64_t value) {
    score_.sections.back().entries.push_back({std::move(key), std::move(label), "", value, 0});
  }
  /// Adds a number with its unit and decimals; one that is not finite is not scored, for the reason `missing`.
  void number(std::string key, std::string label, std::string unit, double value, int decimals,
              const std::string& missing = "not a number") {
    if (std::isfinite(value))
      score_.sections.back().entries.push_back({std::move(key), std::move(label), std::move(unit), value, decimals});
    else
      score_.not_scored.emplace_back(std::move(key), missing);
  }
  void skip(std::initializer_list<const char*> keys, const std::string& why) {
    for (const auto* key : keys) score_.not_scored.emplace_back(key, why);
  }
  void note(std::string text) { score_.notes.push_back(std::move(text)); }  ///< a remark below the score
  Score take() { return std::move(score_); }                                ///< as filled in so far

 private:
  Score score_;
};

struct Scored {
  const Run& run;
  const Options& options;
  const Survey* survey;  ///< null: none
  const Thalweg& thalweg;
  std::optional<Place> crown;
  double crown_along = 0;  ///< where the crown lies along the thalweg [m]; NaN without one
};

/// Run-outs from the crown [m]; NaN where there is none.
struct Reach {
  double straight = 0;  ///< to the cell above the threshold that is farthest as the crow flies
  double along = 0;     ///< along the thalweg, to the cell that is farthest along it
};
/// Run-outs from the crown to cells of `values` above `threshold`.
Reach reach_of(const Scored& scored, const MapGrid& grid, const std::vector<double>& values, double threshold);
/// Run-outs to surveyed `values` above `threshold`: where these have an error, to patches that hold a value that is
/// sure.
Reach surveyed_reach_of(const Scored& scored, const std::vector<double>& values, double threshold);
/// The run-outs of the simulation that the survey's are compared with: where the survey has a level of detection,
/// those of what it could have detected.
Reach simulated_reach(const Scored& scored, const OnSurveyGrid& simulated);

void add_run(const Scored& scored, Sheet& sheet);       ///< volumes, computation, extent
void add_mobility(const Scored& scored, Sheet& sheet);  ///< run-out, drop, angles, travel
void add_hazard(const Hazard& hazard, Sheet& sheet);    ///< intensity, angle of reach, buildings
/// Overlap, thickness and run-out against the survey, and what that means in units of the survey's error.
void add_agreement(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet);
/// Adds how far the scores vary within the error of the survey.
void add_spread(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet);
/// Adds what the words of a score mean.
void add_definitions(const Scored& scored, Sheet& sheet);

/// Scores of surveys drawn within their error, a value each draw. Empty vectors: not asked for, or no error is known.
struct Resampled {
  std::vector<double> footprint_csi;  ///< empty unless the footprint is a surveyed change
  std::vector<double> deposit_csi, rmse, bias, volume, volume_ratio, runout_difference, thalweg_runout_difference;
};

/// Each draw is measured + sigma g with g from RandomField, brought under the level of detection again, and scored as
/// the survey is. Cells measured as exactly 0 stay so. For the run-out only patches of deposit count that touch a
/// deposit of the survey. The survey holds one such error already: the mean lies below a score that errors lower.
Resampled resample(const Scored& scored, const OnSurveyGrid& simulated);

}  // namespace talus::postprocess
