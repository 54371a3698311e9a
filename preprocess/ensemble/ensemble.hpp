// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The ensemble of a recipe: its members are drawn and checked before the base domain is made, and written after it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/ensemble/member_table.hpp"
#include "common/recipe/recipe.hpp"
#include "preprocess/ensemble/draw.hpp"
#include "preprocess/ensemble/elevation_errors.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/output/provenance.hpp"

namespace talus::preprocess {

/// What a member has of [preprocess] in the place of the base's, "key=value" each, without thickness_factor, by
/// which talus-solve scales.
std::vector<std::string> ground_of(const MemberTable& table, std::int64_t member);

/// Whether a key is this one, or lies in this table.
bool is_below(const std::string& key, const std::string& table);

/// Refuses (RecipeError) keys that may not vary, with the reason: those of other tables than [preprocess] and [solve],
/// those that would give members maps of different cells, obstacles (their bodies are written once), thickness_factor
/// beside one in the recipe, or where rows of the bed hold by volume.
void check_keys(const MemberTable& table, const Options& base);

/// The options of [preprocess] of each member that has ground of its own; none for the others. Throws RecipeError with
/// the first member that cannot be read, its value and why: keys that are not there, values out of range or of another
/// kind. Values of [solve] are put in, and left to talus-solve to read.
std::vector<std::optional<Options>> options_of_members(const recipe::Recipe& recipe, const MemberTable& table);

/// What [ensemble] asks for.
struct EnsemblePlan {
  EnsembleOptions options;
  MemberTable table;
  std::vector<std::optional<Options>> ground;             ///< [members]: of those that have ground of their own
  std::optional<ElevationErrors> errors = {};             ///< once the base scene is read
  std::vector<std::vector<std::string>> own_values = {};  ///< [members]: "key=value" of [preprocess], of slides and of
                                                          ///< a budget; empty: as the table's columns say

  /// The number of the random field by which a member's ground errs; none: it errs by none.
  std::optional<std::int64_t> field_of(std::int64_t member) const;
};

/// Draws the members and checks their recipes; none without an ensemble. Throws RecipeError and DataError.
std::optional<EnsemblePlan> plan_ensemble(const recipe::Recipe& recipe, const Options& base);

/// The files beside the recipe that [ensemble] names.
std::vector<std::filesystem::path> inputs_of(const EnsembleOptions& options);

/// What people read of a plan.
std::vector<std::string> as_lines(const EnsemblePlan& plan);

struct EnsembleBase {
  Options options;     ///< as the recipe gives them
  SceneRasters scene;  ///< before anything is scaled, laid or seeded
  SurveyMemory& memory;
  Facts inputs, marks;  ///< of the base domain
  Facts checksums;      ///< of obstacles.vdb; empty: there is none
  std::vector<MapPlace> obstacles;
};

/// Gives the members of a budget their cells and errors of the survey, once the base scene is read, whose layers are so
/// high [m]. A member that the scene does not allow is named in the table with the reason.
void plan_budget_domains(const recipe::Recipe& recipe, EnsemblePlan& plan, const EnsembleBase& base, double layer);

/// Refuses (RecipeError) a key of [preprocess] that changes nothing of the domain: between its smallest value and its
/// largest, with the others as the recipe has them.
void refuse_idle_keys(const recipe::Recipe& recipe, const EnsemblePlan& plan, const EnsembleBase& base);

/// Writes members' domains, in parallel, then members.h5. Domains that are there and say that they were made of the
/// same are left as they are. What an ensemble before left is removed. A member whose domain cannot be made is named in
/// members.h5 and left out. Throws DataError: beyond failed_share of them; a member on another grid than the base. Of
/// slides, each on its window of the lattice, all that cannot be made are told. Returns the slide of most points.
std::int64_t write_ensemble(StageContext& context, EnsemblePlan& plan, const EnsembleBase& base);

/// Removes members.h5 and members' domains but those that `plan` has.
void remove_members(const EnsemblePaths& paths, const EnsemblePlan* plan);

}  // namespace talus::preprocess
