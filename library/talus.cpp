// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "library/talus.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/domain/threads.hpp"
#include "common/ensemble/options.hpp"
#include "common/stage/files.hpp"
#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/stage.hpp"
#include "preprocess/obstacle/obstacles.hpp"
#include "preprocess/output/provenance.hpp"
#include "preprocess/particles/seed.hpp"
#include "preprocess/scene/prepare.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/plan/describe_plan.hpp"
#include "solver/plan/named_places.hpp"
#include "solver/plan/plan.hpp"
#include "solver/run/products.hpp"
#include "solver/run/recorders/frames.hpp"
#include "solver/run/run_loop.hpp"
#include "solver/run/run_stage.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus {
namespace {

constexpr const char* caller = "libtalus";

/// A stage's surroundings for functions that take them.
StageContext context_of(const recipe::Recipe& recipe, const std::filesystem::path& out = {}) {
  return {.recipe = recipe.with({}), .out = out, .command_line = caller};
}

/// The shaking of an accelerogram in memory; none where it is empty. Throws DataError.
std::shared_ptr<const solver::Shaking> shaking_of(const Accelerogram& given) {
  if (given.time.empty()) return nullptr;
  const auto refuse = [](std::string what, std::string why) {
    throw DataError({"accelerogram in memory: " + std::move(what), std::move(why), "Check its times and values"});
  };
  if (given.time.size() < 2 || given.acceleration.size() != given.time.size())
    refuse(fmt::format("{} times, {} accelerations", given.time.size(), given.acceleration.size()),
           "each of two or more samples has both");
  std::vector<Vec3<double>> accelerations;
  for (std::size_t n = 0; n < given.time.size(); ++n) {
    const auto& [x, y, z] = given.acceleration[n];
    if (!std::isfinite(x + y + z)) refuse(fmt::format("sample {} is not finite", n), "it acts as a force");
    if (!(given.time[n] >= 0) || (n > 0 && !(given.time[n] > given.time[n - 1])))
      refuse(fmt::format("time {:g} s of sample {}", given.time[n], n), "times increase, from 0 s on");
    accelerations.push_back({x, y, z});
  }
  return std::make_shared<const solver::Shaking>(solver::make_shaking(given.time, accelerations));
}

/// This function gives obstacles without a file the bodies of the site.
void take_bodies(const Site& site, solver::SolveOptions& options) {
  for (solver::ObstacleOptions& o : options.obstacles) {
    if (!o.level_set.empty()) continue;
    const std::string& name = o.grid.empty() ? o.name : o.grid;
    const auto found =
        std::find_if(site.obstacles.begin(), site.obstacles.end(), [&](const auto& b) { return b.name == name; });
    if (found == site.obstacles.end())
      throw RecipeError({fmt::format("[[solve.obstacle]] name = \"{}\": the site has no body of this name", o.name),
                         "an obstacle without level_set is one of Site::obstacles", "Add it there, or give level_set"});
    const double voxel = site.obstacle_voxel > 0
                             ? site.obstacle_voxel
                             : preprocess::obstacle_voxel(site.domain.grid.cell, site.domain.layer_height);
    o.body = std::make_shared<const VoxelBody>(VoxelBody{*found, voxel});
  }
}

solver::SolveOptions options_of(const Site& site, const recipe::Recipe& recipe) {
  auto options = solver::with_preset(recipe.read<solver::SolveOptions>("solve"));
  if (ensemble_of(recipe).on() || options.stability.factor_of_safety)
    throw RecipeError({"a plan with [ensemble], [slides] or factor_of_safety", "it is of one run in time",
                       "Leave the tables out, or run talus-solve"});
  take_bodies(site, options);
  if ((options.shaking.record = shaking_of(site.shaking))) {
    options.shaking.start = site.shaking.time.front();
    std::vector<Fault> faults;
    recipe::find_unmet(options, faults);
    if (!faults.empty()) throw RecipeError(std::move(faults));
  }
  return solver::with_places(std::move(options), site.domain.places);
}

/// Keeps frames in memory, and hands records to the caller's keeper.
class MemoryKeeper : public solver::RunKeeper {
 public:
  MemoryKeeper(solver::RunLoop& loop, Keeper& keeper) : loop_(loop), keeper_(keeper) {}

  void put_frame(double time) override {
    frames.time.push_back(time);
    frames.thickness.push_back(loop_.stepper().solver().thickness());
  }
  bool pass_record(double) override { return keeper_.record(Moment(loop_)); }
  void pass_batch(const solver::BatchReport&) override {
    stop_if_interrupted("running");
    keeper_.pass_steps();
  }
  void pass_whole_state(bool) override {}

  RunFrames frames;

 private:
  solver::RunLoop& loop_;
  Keeper& keeper_;
};

/// The points of a loop now.
PointFrame points_of(solver::RunLoop& loop) {
  const solver::Stepper& stepper = loop.stepper();
  return solver::point_frame(loop.scene(), loop.options(), stepper.time(), stepper.solver().shown());
}

}  // namespace

Domain make_domain(Raster bed, Raster thickness, double layer_height, std::array<int, 3> per_cell) {
  const MapGrid& grid = bed.grid;
  if (!grid.has_cells_of(thickness.grid) || bed.values.size() != grid.count() ||
      thickness.values.size() != grid.count())
    throw DataError({"bed and thickness in memory: not one grid", "a column of the grid stands over each cell",
                     "Give rasters with the same cells, and a value for each"});
  if (!(grid.cell > 0) || *std::min_element(per_cell.begin(), per_cell.end()) < 1)
    throw DataError({fmt::format("domain in memory: cells of {:g} m with {} x {} x {} points", grid.cell, per_cell[0],
                                 per_cell[1], per_cell[2]),
                     "both are positive", "Give the width of a cell in metres, and one point or more along each axis"});
  double volume = 0;
  for (const double t : thickness.values) {
    if (t < 0 || std::isinf(t))
      throw DataError({fmt::format("thickness in memory: {:g} m", t), "it is 0 or more", "Check its sign and unit"});
    if (t > 0) volume += t;
  }
  if (!(volume > 0)) throw DataError({"thickness in memory: nowhere above 0", "nothing would move", "Check its unit"});
  for (double& t : thickness.values)
    if (std::isnan(t)) t = 0;
  Domain domain;
  domain.grid = grid;
  domain.layer_height = layer_height > 0 ? layer_height : preprocess::default_layer_height(thickness, grid.cell);
  domain.before = bed;
  for (std::size_t c = 0; c < grid.count(); ++c) domain.before.values[c] += thickness.values[c];
  domain.release_names = {"release"};
  preprocess::GridOptions options;
  options.points_per_cell = {per_cell[0], per_cell[1], per_cell[2]};
  domain.points =
      preprocess::seed_points({{"release", thickness}}, preprocess::seeding_of(options, domain.layer_height));
  domain.terrain = std::move(bed);
  domain.release_thickness = std::move(thickness);
  return domain;
}

Site prepare(const recipe::Recipe& recipe) {
  const ThreadsOfLibraries threads(thread_limit());
  const auto options = recipe.read<preprocess::Options>("preprocess");
  Findings found("preprocess", options.accept);
  preprocess::Prepared prepared = preprocess::prepare(options, preprocess::Points::seeded);
  const Facts inputs = preprocess::checksums_of(prepared.inputs);
  prepared.domain.provenance = preprocess::provenance_of(
      context_of(recipe), inputs, preprocess::marks_of(recipe, options, inputs), preprocess::facts_of(prepared));
  prepared.domain.findings = found.list();
  return {.domain = std::move(prepared.domain),
          .obstacles = std::move(prepared.obstacles),
          .obstacle_voxel = prepared.obstacle_voxel};
}

Plan::Plan(Site site, const recipe::Recipe& recipe)
    : scene_(recipe.scene_name()), title_(recipe.title()), mark_(recipe_mark(recipe, "solve")) {
  const ThreadsOfLibraries threads(thread_limit());
  const solver::SolveOptions options = options_of(site, recipe);
  plan_ = solver::plan(std::move(site.domain), options);
  for (const std::string& reason : plan_->reasons) log_info(reason);
  solver::add_findings_of(*plan_);
}

const MapGrid& Plan::grid() const { return plan_->domain->grid; }
std::size_t Plan::points() const { return plan_->scene.points.size(); }
std::vector<Finding> Plan::findings() const { return solver::findings_of(*plan_); }

std::vector<std::string> Plan::description(On on) const {
  const ThreadsOfLibraries threads(thread_limit());
  return solver::describe_plan(*plan_, solver::make_device(solver::choose_device(on)));
}

const MapGrid& Moment::grid() const { return loop_.scene().map; }
double Moment::time() const { return loop_.stepper().time(); }
std::int64_t Moment::steps() const { return loop_.stepper().solver().clock().step; }
const RunHistory& Moment::history() const { return loop_.history().rows(); }
std::vector<double> Moment::thickness() const { return loop_.stepper().solver().thickness(); }
RunMaps Moment::maps() const {
  const solver::SolverState state = loop_.stepper().solver().end_state();
  return solver::final_maps(loop_.end(state), thickness());
}
PointFrame Moment::points() const { return points_of(loop_); }

Result run(const Plan& plan, On on) {
  Keeper none;
  return run(plan, on, none);
}

Result run(const Plan& plan, On on, Keeper& keeper) {
  const ThreadsOfLibraries threads(thread_limit());
  const Findings found("solve", plan.plan_->options.accept);
  solver::RunTimer timer;
  solver::RunLoop loop(plan.plan_, solver::make_device(solver::choose_device(on)));
  MemoryKeeper memory(loop, keeper);
  loop.start();
  Result result;
  result.summary.scene = plan.scene_;
  result.summary.title = plan.title_;
  result.summary.stop_reason = loop.step_to_end(memory, true);
  result.summary.provenance = plan.plan_->domain->provenance;
  result.summary.provenance.emplace_back(recipe_of_run, plan.mark_);
  result.summary.provenance.emplace_back(run_id, new_run_id());
  loop.memory().wall_time = timer.seconds();
  const solver::SolverState state = loop.stepper().solver().end_state();
  const solver::RunEnd end = loop.end(state);
  loop.measure(end, result.summary);
  loop.history().conclude();
  solver::say_sanity(result.summary.sanity);
  result.summary.places = solver::places_of(*plan.plan_);
  result.summary.findings = plan.findings();
  result.summary.findings.insert(result.summary.findings.end(), found.list().begin(), found.list().end());
  result.maps = solver::final_maps(end, loop.stepper().solver().thickness());
  result.frames = std::move(memory.frames);
  result.history = loop.history().rows();
  result.points = points_of(loop);
  return result;
}

std::vector<std::filesystem::path> write(const Result& result, const recipe::Recipe& recipe,
                                         const std::filesystem::path& folder) {
  make_folder(folder);
  StageContext context = context_of(recipe, std::filesystem::absolute(folder).lexically_normal());
  const OutputLock lock(context.out, caller);
  const std::filesystem::path file = context.out / "run.h5";
  RunWriter writer(file);
  for (std::size_t n = 0; n < result.frames.time.size(); ++n)
    writer.append_thickness(result.frames.time[n], result.maps.grid, result.frames.thickness[n]);
  writer.finish(result.maps, result.history, result.summary);
  context.results = {file};
  postprocess::run(context);
  return context.results;
}

}  // namespace talus
