// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// One row for each member: what it was given, and what came of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Where a column comes from.
enum class ColumnKind { input, result, score };

/// A column of numbers, or of words.
struct RowColumn {
  ColumnKind kind{};
  std::string name;                ///< "solve.base.friction_angle_deg", "run_out_m", "footprint_csi"
  std::string unit;                ///< in UDUNITS' words; empty where the name of a key says it
  std::string title;               ///< what it is
  std::vector<double> values;      ///< [members]; NaN where there is none; of words: their places in `words`
  std::vector<std::string> words;  ///< that it takes; empty: numbers
};

/// The table of members.
struct MemberRows {
  std::vector<MemberState> states;    ///< [members]
  std::vector<std::string> failures;  ///< [members]: why it failed or was left out; empty otherwise
  std::vector<std::string> warnings;  ///< [members]: what it warned of; empty otherwise
  std::vector<RowColumn> columns;
};

/// The state of a member in words: "left out".
const char* word_of(MemberState state);

/// Inputs, results, and scores against the survey where there is one.
MemberRows member_rows(const Ensemble& ensemble, const Options& options, const std::optional<Survey>& survey);

/// The table as comma-separated values (RFC 4180): number, state, the columns, failure. Numbers as they round-trip.
/// `called`: what the numbers are of.
std::string members_csv(const MemberRows& rows, const char* called = "member");

/// Of each member: CSI, hit rate and false alarm ratio of its flow's footprint, and CSI of its deposit's, as
/// postprocess/score/contingency.hpp has them, on the survey's grid. A cell of that grid is covered where the
/// footprint covers more than half of it. Where the thickness of the members' deposits was kept, its root mean square
/// and mean error too, over the cells where either exceeds the threshold. Of a surveyed change the cells that were
/// released are left out of the deposit, for what lies there is no gain of height.
std::vector<RowColumn> member_scores(const Ensemble& ensemble, const Survey& survey, double deposit_threshold);

}  // namespace talus::postprocess
