// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The members of an ensemble as the solver runs them: a domain and options each.
#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>

#include "common/domain/domain.hpp"
#include "common/ensemble/counts.hpp"
#include "common/ensemble/member_table.hpp"
#include "common/recipe/recipe.hpp"
#include "solver/ensemble/variations.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/plan.hpp"
#include "solver/plan/step_choice.hpp"

namespace talus::solver {

/// What stiffness, integrator and accuracy that a recipe leaves to the program are settled at for all members; the
/// thickness from which cells count is the same for all in any case.
struct SettledOnce {
  std::optional<double> map_threshold;
  std::optional<StiffnessDemand> stiffness;
  std::optional<StepChoice> steps;
};

/// The members of an ensemble. Its methods may be called by several threads at a time.
class Members {
 public:
  /// The constructor keeps references to recipe and table. `base` are the options of the recipe itself,
  /// and what is left to the program is settled for all members by them, unless a key that bears on it varies. It
  /// throws RecipeError where a varied key would have no effect, and where a budget sets what cannot be.
  Members(const recipe::Recipe& recipe, const MemberTable& table, const EnsemblePaths& paths,
          std::shared_ptr<const Domain> domain, const SolveOptions& base);

  /// Reads every member's options. It throws RecipeError with the first member that the recipe does not allow.
  void check() const;
  /// The plan of a member; it reads files. It throws as plan() does, and DataError: a domain of its own that could not
  /// be made, is missing, or is on another grid.
  std::shared_ptr<const Plan> plan(std::int64_t member) const;
  const SolveOptions& base() const { return base_; }
  /// Whether what is left to the program is settled for each member by itself.
  bool settles_each() const { return settles_each_; }
  /// This method notes in counts what the members of a budget change, and leaves those out that are not to be run.
  void note_changes(EnsembleCounts& counts) const;

 private:
  SolveOptions options_of(std::int64_t member) const;
  std::shared_ptr<const Domain> domain_of(std::int64_t member) const;
  void vary(const Plan& base);

  const recipe::Recipe& recipe_;
  const MemberTable& table_;
  EnsemblePaths paths_;
  std::shared_ptr<const Domain> domain_;
  bool settles_each_;
  SettledOnce settled_;
  SolveOptions base_;
  std::vector<Variation> variations_;  ///< [members] of a budget; else empty
  mutable std::mutex reading_;         ///< recipes are read by one thread at a time
};

}  // namespace talus::solver
