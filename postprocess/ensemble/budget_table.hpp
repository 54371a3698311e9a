// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The error budget of a recipe: how far each doubt moves its deposit, and where.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/map/raster.hpp"
#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// A line of the table: a member of a budget, and how far it differs from the recipe itself.
struct BudgetLine {
  std::string name;                      ///< "friction-less"
  const BudgetRow* row = nullptr;        ///< the doubt that it asks about; null: it is the recipe itself
  std::string words = {};                ///< what is other
  std::vector<std::string> values = {};  ///< keys by which the same run is made by hand
  MemberState state{};
  std::string reason = {}, warnings = {};  ///< why it failed or was left out; what it warned of
  MemberResult result = {};                ///< NaN where it is not counted
  double volume = nan;                     ///< of the deposit [m3]
  double elsewhere = nan;           ///< share of the deposit that lies elsewhere, in the coarser cells of the two,
                                    ///< volumes set equal [-]
  double overlap = nan;             ///< of the footprints: area of both over area of either [-]
  double largest_change = nan;      ///< of the thickness of the deposit, in any cell [m]
  double p99_change = nan;          ///< 99 % of the cells of either deposit change by less [m]
  std::vector<double> scores = {};  ///< by BudgetTable::scores
};

/// A map of spread: largest less smallest thickness of the deposit over the recipe itself and members of it [m].
struct SpreadMap {
  const char* name;  ///< of its file: "deposit_spread"
  const char* over;  ///< "all doubts"
  Raster raster;     ///< NaN outside the domain
};

struct BudgetTable {
  BudgetLine own;                   ///< the recipe itself
  double threshold = 0;             ///< thickness to which run-outs are measured [m]
  std::vector<std::string> scores;  ///< names of scores against the survey, as in members.csv
  std::vector<BudgetLine> lines;    ///< the largest `elsewhere` first; then what failed, then what was left out
  std::vector<SpreadMap> spreads;   ///< over all members, over the physical rows, over the numerical ones
};

/// Compares the members of a budget with the recipe itself. Throws DataError where that failed or was not run.
BudgetTable budget_table(const Ensemble& ensemble, const MemberRows& rows, const Options& options);

/// Warns where other last digits move more than a fiftieth of the deposit.
void warn_of_chaos(const BudgetTable& table);

/// The table as comma-separated values, a row for each member.
std::string budget_csv(const BudgetTable& table);

/// The table as JSON: "own" has the numbers of the recipe itself, "rows" the lines.
nlohmann::ordered_json budget_json(const BudgetTable& table);

/// The table for people, aligned.
std::string budget_words(const BudgetTable& table);

}  // namespace talus::postprocess
