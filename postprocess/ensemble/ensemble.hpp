// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// An ensemble as talus-preprocess and talus-solve left it: who its members are, what was counted of them, and a row for
// each: what it was given, and what came of it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/ensemble/options.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/report/page.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// Members, and the counts of all parts that were found.
struct Ensemble {
  MemberTable table;
  EnsembleCounts counts;                     ///< merged: of all members
  std::vector<std::filesystem::path> files;  ///< members.h5, then the counts
  std::vector<Finding> findings;             ///< of this stage

  // Numbers of members whose run is in the counts, whose run failed, and that no file of counts holds.
  std::int64_t counted() const { return counts.count(MemberState::counted); }
  std::int64_t failed() const { return counts.count(MemberState::failed); }
  std::int64_t waiting() const { return counts.count(MemberState::waiting); }
};

/// Reads members.h5 and the counts in the output folder, and checks that they belong together and to the recipe.
/// Warns of members that wait and of those that failed. Throws DataError: missing, damaged, of another recipe or of
/// different ensembles, or with no member that was counted.
Ensemble read_ensemble(const StageContext& context);

/// The files that read_ensemble() would read in an output folder; counts.h5 where there are no counts yet.
std::vector<std::filesystem::path> ensemble_files(const std::filesystem::path& out);

/// The scene of an ensemble as maps of a run in which nothing has moved yet: grid, ground and release.
RunMaps base_maps(const EnsembleScene& scene);

/// Numbers of members as people write them: "3, 7 to 12, 40"; no more than `most` of these, then how many are left.
std::string member_list(const std::vector<std::int64_t>& members, std::size_t most = 12);

/// How many members of which kind, as one sentence: "98 of 100 members are counted, 2 failed, 0 wait".
std::string members_words(const Ensemble& ensemble);

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

/// How the shares of the members that come to a cell agree with a surveyed footprint.
struct ShareScore {
  const char* of;     ///< "footprint" or "deposit"
  double held = nan;  ///< share of the surveyed area to which more than 5 % of the members come
  double csi = nan;   ///< critical success index of the cells to which more than half of them come
  double brier = nan;
};

struct MemberRows {
  std::vector<MemberState> states;    ///< [members]
  std::vector<std::string> failures;  ///< [members]: why it failed or was left out; empty otherwise
  std::vector<std::string> warnings;  ///< [members]: what it warned of; empty otherwise
  std::vector<RowColumn> columns;
  Json likelihood;                       ///< likelihood.json (comparison.hpp); null: nothing is compared with a survey
  std::vector<ShareScore> share_scores;  ///< where members are draws and there is a survey
};

/// The surveyed deposit where members' footprints can be compared with it: of a change not where there was a release.
std::vector<double> comparable_deposit(const Survey& survey, const EnsembleScene& scene);

/// The state of a member in words: "left out".
const char* word_of(MemberState state);

/// Inputs, results, and scores against the survey where there is one.
MemberRows member_rows(const Ensemble& ensemble, const Options& options, const std::optional<Survey>& survey);

/// The table as comma-separated values (RFC 4180): number, state, the columns, failure. Numbers as they round-trip.
/// `called`: what the numbers are of.
std::string members_csv(const MemberRows& rows, const char* called = "member");

}  // namespace talus::postprocess
