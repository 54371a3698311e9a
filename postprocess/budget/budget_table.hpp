// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The error budget of a run: how far each doubt moves its deposit, and where.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/budget/budget.hpp"
#include "common/qgis/project.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/score/score.hpp"

namespace talus::postprocess {

/// What the other runs are compared with.
struct BudgetReference {
  const Run& run;
  const Options& options;
  const std::optional<Survey>& survey;
  const Thalweg& thalweg;
};

/// Numbers of a run that is compared, or of the run itself; NaN where there is none.
struct BudgetNumbers {
  double run_out = nan;        ///< plan distance from the crown to the deposit's farthest cell [m]
  double largest_speed = nan;  ///< [m/s]
  double p99_speed = nan;      ///< 99 % of the cells that anything came to are slower [m/s]
  double volume = nan;         ///< of the deposit [m3]
  double steps = nan;          ///< number of steps
  double wall_time = nan;      ///< [s]
};

/// A score against the survey, of the run itself and of the others.
struct BudgetScore {
  std::string key;    ///< as in score.json
  std::string label;  ///< as in score.txt
  std::string unit;
  int decimals = 0;
  double own = nan;  ///< of the run itself
};

/// A line of the table: another run, and how far it differs.
struct BudgetLine {
  BudgetRun run;                ///< without its maps
  const BudgetRow* row;         ///< the doubt that it asks about
  double elsewhere = nan;       ///< share of the deposit that lies elsewhere in the other run, in the coarser cells of
                                ///< the two, volumes set equal [-]
  double overlap = nan;         ///< of the footprints: area of both over area of either [-]
  double largest_change = nan;  ///< of the thickness of the deposit, in any cell [m]
  double p99_change = nan;      ///< 99 % of the cells of either deposit change by less [m]
  BudgetNumbers numbers = {};
  std::vector<double> scores = {};  ///< by BudgetTable::scores
};

/// The table, and the maps of spread.
struct BudgetTable {
  BudgetNumbers own;  ///< of the run itself
  std::vector<BudgetScore> scores;
  std::vector<BudgetLine> lines;  ///< the largest `elsewhere` first; then what failed, then what was left out
  std::string options;            ///< [budget] as it was used, in TOML
  /// Largest less smallest thickness of the deposit over the run and the others [m]; NaN outside the domain. Of all, of
  /// the numerical rows, of the physical ones; empty where no run of the kind is done.
  Raster spread, spread_numerical, spread_physical;

  /// The number of runs of a kind that are compared.
  std::size_t compared(BudgetKind kind) const;
};

/// The name of a kind: "numerical".
const char* kind_name(BudgetKind kind);

/// Compares the runs of `file` with the run that they were made beside; none where there is no such file, or it is of
/// another run, which is warned of. Throws DataError.
std::optional<BudgetTable> budget_table(const std::filesystem::path& file, const BudgetReference& reference);

/// The table as comma-separated values, a row for each run.
std::string budget_csv(const BudgetTable& table);

/// The table as JSON.
std::string budget_json_text(const BudgetTable& table, const Run& run);

/// A map of spread, wherever it goes.
struct SpreadMap {
  const char* name;  ///< of file and NetCDF variable: "deposit_spread"
  const char* long_name;
  const Raster* raster;  ///< in the table
};

/// The maps of spread that a table has.
std::vector<SpreadMap> spread_maps(const BudgetTable& table);

/// Writes the maps of spread, "deposit_spread.tif" and those of the two kinds, each with a style for QGIS beside it. It
/// returns the files. Throws DataError.
std::vector<std::filesystem::path> write_spread_maps(const std::filesystem::path& folder, const Run& run,
                                                     const BudgetTable& table);

/// These maps as layers of the project of QGIS beside them.
ProjectGroup spread_group(const BudgetTable& table);

/// The table for people, aligned.
std::string budget_words(const BudgetTable& table);

}  // namespace talus::postprocess
