// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The sections of a score, in their order.
#pragma once

#include <cmath>
#include <initializer_list>
#include <optional>
#include <string>
#include <utility>

#include "common/run/mobility.hpp"
#include "postprocess/score/score.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Collects entries in sections; a number that is not finite goes to not_scored with the reason given.
class Sheet {
 public:
  explicit Sheet(std::string title) { score_.title = std::move(title); }

  /// Begins a section.
  void section(std::string title) { score_.sections.push_back({std::move(title), {}}); }
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
    if (std::isfinite(value)) {
      score_.sections.back().entries.push_back({std::move(key), std::move(label), std::move(unit), value, decimals});
    } else {
      score_.not_scored.emplace_back(std::move(key), missing);
    }
  }
  /// Says of keys that they are not scored, and why.
  void skip(std::initializer_list<const char*> keys, const std::string& why) {
    for (const auto* key : keys) score_.not_scored.emplace_back(key, why);
  }
  /// Adds a remark below the score.
  void note(std::string text) { score_.notes.push_back(std::move(text)); }
  /// The score as filled in so far; the sheet is empty then.
  Score take() { return std::move(score_); }

 private:
  Score score_;
};

/// What is scored, and what is measured from.
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

void add_run(const Scored& scored, Sheet& sheet);       ///< volumes, computation, extent
void add_mobility(const Scored& scored, Sheet& sheet);  ///< run-out, drop, angles, travel
void add_hazard(const Hazard& hazard, Sheet& sheet);    ///< intensity, angle of reach, buildings
/// Overlap, thickness and run-out against the survey, and what that means in units of the survey's error.
void add_agreement(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet);
/// Adds how far the scores vary within the error of the survey.
void add_spread(const Scored& scored, const OnSurveyGrid& simulated, Sheet& sheet);
/// Adds what the words of a score mean.
void add_definitions(const Scored& scored, Sheet& sheet);

}  // namespace talus::postprocess
