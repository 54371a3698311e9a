// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// libtalus: a landslide from its domain to its maps, in the memory of one process (docs/reference/library.md).
//
//   Site site = prepare(recipe);                 // or made in memory
//   Plan plan(site, recipe);                     // everything before the first step
//   Result result = run(plan, On::cpu);          // maps, points, history, summary
//   write(result, recipe, "out");                // the files of talus-postprocess
//
// All functions work in the Context of the calling thread (common/stage/context.hpp): log, number of threads, network,
// interruption. They throw RecipeError, DataError, NumericalError and Interrupted (common/error.hpp), each with what,
// why and how to mend it. Units are SI, coordinates those of the map, thickness is vertical, row 0 is the southernmost.
#pragma once

#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/domain/level_set.hpp"
#include "common/error.hpp"
#include "common/recipe/recipe.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/context.hpp"
#include "common/stage/findings.hpp"
#include "solver/parallel/on.hpp"

namespace talus {
namespace solver {
struct Plan;
class RunLoop;
}  // namespace solver

/// Accelerations of the ground, linear between the samples; none before the first and after the last one.
struct Accelerogram {
  std::vector<double> time;                         ///< increasing [s]
  std::vector<std::array<double, 3>> acceleration;  ///< along x, y and z of the map [m/s2]
};

/// Input of a plan.
struct Site {
  Domain domain;
  std::vector<SolidBody> obstacles = {};  ///< those of [[solve.obstacle]] without a level_set, by name
  double obstacle_voxel = 0;              ///< width of the voxels that describe them [m]; 0: a quarter of a cell
  Accelerogram shaking = {};              ///< in the place of [solve.shaking] file; empty: none
};

/// The domain of a bed and a released thickness on one grid, seeded with `per_cell` points along x, y and the height of
/// a layer [m] (0: by the thickness). Throws DataError: other grids; no, negative or infinite thickness; no cell.
Domain make_domain(Raster bed, Raster thickness, double layer_height = 0, std::array<int, 3> per_cell = {2, 2, 2});

/// The site of [preprocess] of a recipe, from the files it names; nothing is written. Throws RecipeError, DataError.
Site prepare(const recipe::Recipe& recipe);

class Keeper;
struct Result;

/// A run before its first step. Copies share it; it never changes.
class Plan {
 public:
  /// The plan of [solve] of a recipe. Throws RecipeError (a recipe of many runs or of a factor of safety; no such part,
  /// obstacle or gauge) and DataError (a point outside the ground, implausible numbers that the recipe does not
  /// accept).
  Plan(Site site, const recipe::Recipe& recipe);

  const MapGrid& grid() const;  ///< the cells of the maps
  std::size_t points() const;   ///< number of material points at the start
  /// A line each on what is on, memory, steps and time, as talus-solve --plan prints them. Takes a few steps.
  std::vector<std::string> description(On on = On::automatic) const;
  std::vector<Finding> findings() const;  ///< advice, warnings and overridden refusals of the site and the plan

 private:
  friend Result run(const Plan& plan, On on, Keeper& keeper);
  std::shared_ptr<const solver::Plan> plan_;
  std::string scene_, title_, mark_;  ///< of the recipe
};

/// A run at one of its records. It is valid in the call that it is passed to; what the methods return is the caller's.
class Moment {
 public:
  explicit Moment(solver::RunLoop& loop) : loop_(loop) {}
  const MapGrid& grid() const;            ///< of the maps
  double time() const;                    ///< [s]
  std::int64_t steps() const;             ///< taken so far
  const RunHistory& history() const;      ///< up to this record
  std::vector<double> thickness() const;  ///< [rows * columns] [m]
  RunMaps maps() const;                   ///< as they would be if the run ended now
  PointFrame points() const;              ///< in no order
 private:
  solver::RunLoop& loop_;
};

/// What a caller does with a run as it goes on.
class Keeper {
 public:
  virtual ~Keeper() = default;
  /// Called each [solve] history_interval_s, from the start on. False ends the run.
  virtual bool record(const Moment& /*now*/) { return true; }
  virtual void pass_steps() {}  ///< called after every few steps; it may throw to give the run up
};

/// A finished run.
struct Result : Run {
  PointFrame points;  ///< at the end
};

/// Takes the steps of a plan to its end. Throws RecipeError (a GPU is asked for and there is none), NumericalError,
/// Interrupted, and what the keeper throws.
Result run(const Plan& plan, On on = On::automatic);
Result run(const Plan& plan, On on, Keeper& keeper);

/// Writes run.h5 without its points, and the outputs of [postprocess]; the paths. Throws RecipeError, DataError.
std::vector<std::filesystem::path> write(const Result& result, const recipe::Recipe& recipe,
                                         const std::filesystem::path& folder);

}  // namespace talus
