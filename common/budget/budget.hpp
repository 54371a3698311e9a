// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// budget.h5: what talus-solve hands to talus-postprocess of an error budget, and the files around it.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/budget/options.hpp"
#include "common/ensemble/counts.hpp"
#include "common/map/raster.hpp"
#include "common/stage/identity.hpp"

namespace talus {

/// The names of the files of an error budget in the output folder `out`.
struct BudgetPaths {
  std::filesystem::path out;

  /// The results of its runs.
  std::filesystem::path budget() const { return out / "budget.h5"; }
  /// What a computation that was stopped has finished.
  std::filesystem::path unfinished() const { return out / "budget.unfinished.h5"; }
  /// The folder of the domains that its runs need beside the run's own.
  std::filesystem::path folder() const { return out / "budget"; }
  /// Which of them could be made, and why the others could not: a line "NAME: made" or "NAME: left out: WHY" each.
  std::filesystem::path domains() const { return folder() / "domains.txt"; }
  /// One of them: "cells", "survey-1".
  std::filesystem::path domain(const std::string& name) const { return folder() / ("domain." + name + ".vdb"); }
};

/// The name of the domain and the run with the nth draw of the survey's error, from 1.
std::string survey_draw_name(int draw);

/// Names of facts that those domains carry.
inline constexpr const char* budget_base = "budget.base";      ///< id of the domain that they are beside
inline constexpr const char* budget_values = "budget.values";  ///< keys that make such a domain by hand

/// What became of a run of a budget.
enum class BudgetState { waiting, done, failed, left_out };

/// A run of a budget: what is other in it, and what came of it.
struct BudgetRun {
  std::string name;                 ///< "friction-less"
  std::string row;                  ///< "friction"
  std::string words;                ///< what is other: "cells of 40 m instead of 20 m"
  std::vector<std::string> values;  ///< keys by which the same run is made by hand: "solve.cfl=0.25"
  std::string domain = {};          ///< name of a domain of its own; empty: that of the run
  BudgetState state = BudgetState::waiting;
  std::string reason = {};                   ///< why it failed or was left out
  Facts accepted = {};                       ///< what the recipe insists on and this run met
  std::vector<std::string> warnings = {};    ///< what this run warned of
  MemberResult result = {};                  ///< of a run that is done
  Raster deposit = {}, peak_thickness = {};  ///< likewise [m]
};

/// The runs of a budget beside the run itself.
struct Budget {
  std::string fingerprint;  ///< of domains and settings
  std::string run;          ///< id of the run in run.h5
  std::string options;      ///< [budget] as it was used, in TOML
  std::vector<BudgetRun> runs;
  Facts provenance;

  /// The number of runs of a state.
  std::size_t count(BudgetState state) const;
};

/// Writes it, sealed and aside. Throws DataError.
void write_budget(const std::filesystem::path& file, const Budget& budget);

/// Reads it back. Throws DataError: missing, damaged, no budget, or holding what cannot be.
Budget read_budget(const std::filesystem::path& file);

}  // namespace talus
