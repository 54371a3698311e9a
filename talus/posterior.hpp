// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a calibration tells of its keys, in numbers and in sentences.
#pragma once

#include <string>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "talus/tempering.hpp"

namespace talus::command {

/// Quantiles of 5, 50 and 95 %.
struct Quantiles {
  double low = 0, median = 0, high = 0;
};

/// What is known of a key before and after the survey.
struct KeySummary {
  std::string key;
  Quantiles prior, posterior;  ///< of words: none
  double left = 0;             ///< deviation of the posterior over that of the prior, where the prior is normal [-]
  double shift = 0;            ///< of the posterior's median from the prior's, in deviations of the prior [-]
};

/// A direction in the space of the keys, of length one, each key in deviations of its prior.
struct Direction {
  std::vector<double> of_keys;
  double left = 0;  ///< deviation of the posterior along it over that of the prior [-]
};

/// How large the model's discrepancy is beside the survey's error.
struct DiscrepancySummary {
  std::string name, unit;            ///< "thickness of the deposit", "m"
  double deviation = 0;              ///< its mean after the survey [unit]
  double length = 0;                 ///< [m]
  double survey_error = 0;           ///< [unit]
  double at_least = 0, at_most = 0;  ///< how probable it is that the deviation is the smallest, the largest looked for
};

struct PosteriorSummary {
  std::vector<KeySummary> keys;
  std::vector<Direction> directions;  ///< of the posterior's main axes, what the survey tells best first
  std::vector<DiscrepancySummary> discrepancies;
  double log_evidence = 0, log_evidence_error = 0;
};

/// A direction of which more than this is left is one that the survey does not tell [-].
inline constexpr double not_told = 0.8;

/// Keys and directions. `prior`, `posterior`: tables of the draws' values.
PosteriorSummary summary_of(const Posterior& draws, const MemberTable& prior, const MemberTable& posterior);

/// A table with a line for each key.
std::vector<std::string> table_lines(const PosteriorSummary& summary);

/// Sentences: what the survey does not tell, what lies at the edge of the prior, what the model's discrepancy is beside
/// the survey's error.
std::vector<std::string> conclusions(const PosteriorSummary& summary);

}  // namespace talus::command
