// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The numbers of a run, and how well it agrees with a survey.
//
// Definitions (the same words stand under score.txt; those of single scores with the functions that compute them):
// - footprint: peak thickness above footprint_threshold_m; the survey's is its peak thickness above the same threshold,
// or
//   the inside of its polygon, or |after - before| above the threshold.
// - deposit: final thickness above deposit_threshold_m. Against a surveyed change (after - before), both sides are the
// rise
//   of the surface: max(0, after - before) and max(0, final - initial thickness), because in the source area the
//   slide's own scar is not deposit.
// - run-out L: distance in plan from the crown (highest cell of the release), straight to the farthest deposit cell, or
// along
//   the thalweg to the deposit cell farthest along it; H: drop of the surface before the failure between the two; H/L
//   is the tangent of the Fahrboeschung (Heim 1932).
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/score/thalweg.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

struct Hazard;

/// One number or word of a score.
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

/// Warns of a run that ended with its simulated time, and not at rest.
void warn_of_end(const Run& run);

/// Scores a run along thalweg_of(run, options).
Score make_score(const Run& run, const Options& options, const std::optional<Survey>& survey);

/// One flat object: key -> value; a value that does not exist is absent, and `not_scored` says why. `findings` is an
/// array of objects.
std::string to_json(const Score& score);

/// A score as an aligned table with the findings and the definitions below it.
std::string to_table(const Score& score);

}  // namespace talus::postprocess
