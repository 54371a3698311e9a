#include "solver/run/stability/stability.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "solver/run/stability/weaken.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {
namespace {

/// An equilibrium is found where this share of the forces is left unbalanced, at most; what fails leaves some
/// thousandths (docs/decisions/0036).
constexpr double balanced = 1e-4;
constexpr int most_iterations = 80;

/// The factor under which the mass is let go, over the one that did not hold.
constexpr double overload = 1.02;
/// The way, in cells, that a mass falling under that part of its weight takes until its motion is looked at.
constexpr double fall = 0.5;
constexpr int fall_steps = 8;
/// The kinetic energy at the end over that at half time from which on the mass moves: a free one has four times as
/// much, one that finds a new equilibrium less than before.
constexpr double growing = 2;
/// The way of the last equilibrium over that of the first from which on a failure is believed without letting the mass
/// go: ways grow without bound towards the limit.
constexpr double grown = 2;

/// The settings of one step that brings gravity on, from time 0 to 1.
SolverSettings static_settings(const SolveOptions& options, const GridShape& grid, double factor) {
  SolverSettings s = make_settings(weakened(options, factor), grid);
  s.precision = Precision::double_;
  s.integrator = Integrator::quasi_static;
  s.common.gravity.ramp = 1;
  s.common.bed = weakened(s.common.bed, factor);
  s.common.separation = {};
  s.common.damping = 0;
  std::erase_if(s.common.walls, [](const PlaneWall& wall) { return wall.from > 0; });
  for (PlaneWall& wall : s.common.walls) wall.to = 1e30;
  std::erase_if(s.common.loads, [](const Load& load) { return load.from > 0; });
  for (Load& load : s.common.loads) {
    load.ramp = 1;
    load.to = 1e30;
  }
  s.implicit.dynamic = false;
  s.implicit.step = 1;
  s.implicit.step_cuts = 0;
  s.implicit.tangent = Tangent::frozen_yield;
  s.implicit.b_bar = true;
  s.implicit.newton.iterations = std::max(s.implicit.newton.iterations, most_iterations);
  s.implicit.newton.tolerance = balanced;
  return s;
}

/// The same for backward Euler steps of this length [s], with all gravity there.
SolverSettings falling_settings(const SolveOptions& options, const GridShape& grid, double factor, double step) {
  SolverSettings s = static_settings(options, grid, factor);
  s.integrator = Integrator::newmark;
  s.implicit.dynamic = true;
  s.implicit.alpha = 0.5;
  s.implicit.beta = 1;
  s.implicit.step = step;
  s.implicit.step_cuts = 8;
  s.common.gravity.ramp = 0;
  return s;
}

/// The function steps to a time and adds up the iterations.
StepStats advance_to(Solver& solver, double time) {
  StepStats sum;
  solver.set_next_event(time);
  while (solver.clock().time < time) {
    stop_if_interrupted("looking for the factor of safety");
    const BatchReport batch = solver.advance();
    sum.newton += batch.stats.newton;
    sum.linear += batch.stats.linear;
    if (batch.clock.halt == failed)
      throw NumericalError(
          {"a point of the ground was lost", "its state is no number", "Look at the recipe's numbers"});
  }
  return sum;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The ways of points between two states, by id [m].
std::vector<double> ways(const Scene& scene, const TerrainTables& ground, const ParticleState& from,
                         const ParticleState& to) {
  const auto before = positions(scene.map, scene.grid, ground, from),
             after = positions(scene.map, scene.grid, ground, to);
  std::vector<std::array<double, 3>> place(scene.points.size());
  for (std::size_t p = 0; p < from.size(); ++p) place[static_cast<std::size_t>(from.id[p])] = before[p];
  std::vector<double> way(scene.points.size(), 0.0);
  for (std::size_t p = 0; p < to.size(); ++p) {
    const auto id = static_cast<std::size_t>(to.id[p]);
    way[id] = distance(place[id], after[p]);
  }
  return way;
}

/// The mean way of the points, weighed by volume and by the way itself: that of what moves.
double way_of_what_moves(const std::vector<double>& way, const std::vector<double>& volume) {
  double first = 0, second = 0;
  for (std::size_t p = 0; p < way.size(); ++p) {
    first += volume[p] * way[p];
    second += volume[p] * way[p] * way[p];
  }
  return first > 0 ? second / first : 0;
}

std::string words(const StabilityTrial& t) {
  if (!t.holds) return fmt::format("strength / {:.4g}: no equilibrium", t.factor);
  if (t.by_motion) return fmt::format("strength / {:.4g}: no equilibrium found, but let go the ground stays", t.factor);
  return fmt::format(
      "strength / {:.4g}: equilibrium, farthest point {:.3g} m from where it was without weight ({} Newton, {} linear "
      "iterations)",
      t.factor, t.way, t.newton, t.linear);
}

}  // namespace

StabilitySearch::StabilitySearch(const Domain& domain, const SolveOptions& options, const AnyDevice& device)
    : domain_(domain),
      stiffening_(stiffening_of(domain, options)),
      options_(stiffened(options, stiffening_)),
      device_(device) {
  options_.integrator = Integrator::quasi_static;  // the grid of statics
  scene_ = make_scene(domain_, options_);
  seeds_ = positions(scene_.map, scene_.grid, make_terrain_tables(scene_.grid), scene_.points);
}

Stability StabilitySearch::run() {
  Stability found;
  found.stiffening = stiffening_;
  const auto holds = [&](double factor) {
    stop_if_interrupted("looking for the factor of safety");
    found.trials.push_back(attempt(factor));
    const StabilityTrial& trial = found.trials.back();
    log_info(words(trial));
    return trial.holds;
  };
  const StabilityOptions& o = options_.stability;
  found.factor = bracket_factor(holds, {.tolerance = o.tolerance, .largest = o.largest_factor});
  if (found.factor.closed()) found.failure = fail(overload * found.factor.high);
  return found;
}

/// The function brings gravity on, or goes on from the equilibrium `from` where that is given. The state is empty where
/// no equilibrium is found.
std::optional<SolverState> StabilitySearch::rest(double factor, const SolverState* from, StabilityTrial& trial) const {
  const Scene scene = weakened_scene(factor);
  SolverSettings settings = static_settings(options_, scene_.grid, factor);
  if (from) settings.common.gravity.ramp = 0;
  const auto solver = from ? resume_solver(scene, settings, device_, *from) : make_solver(scene, settings, device_);
  try {
    const StepStats effort = advance_to(*solver, solver->clock().time + 1);
    trial.newton += effort.newton;
    trial.linear += effort.linear;
  } catch (const NumericalError& error) {
    log_detail(error.what());
    return {};
  }
  SolverState state = solver->state();
  if (state.points.size() != scene_.points.size()) return {};  // what has left the ground does not rest on it
  return state;
}

/// The scene with the bed's columns weakened.
Scene StabilitySearch::weakened_scene(double factor) const {
  Scene scene = scene_;
  scene.bed = weakened(std::move(scene.bed), options_.base.law, factor);
  return scene;
}

/// A trial: gravity brought on. Where that finds no equilibrium though the last one gave no sign of a limit: the way
/// from there, then the mass let go.
StabilityTrial StabilitySearch::attempt(double factor) {
  StabilityTrial trial{.factor = factor};
  const bool from_below = held_factor_ > 0 && factor > held_factor_;
  std::optional<SolverState> state = rest(factor, nullptr, trial);
  const bool doubtful = from_below && held_way_ < grown * first_way_;
  if (!state && doubtful) state = rest(factor, &held_, trial);
  if (state) {
    trial.holds = true;
    trial.way = farthest(*state);
    if (first_way_ == 0) first_way_ = trial.way;
    if (factor > held_factor_) {
      held_ = std::move(*state);
      held_way_ = trial.way;
      held_factor_ = factor;
    }
  } else if (doubtful) {
    const Failure failure = fail(overload * factor);
    trial.holds = trial.by_motion = !failure.shares.empty() && !failure.moves;
  }
  return trial;
}

/// The mass let go from the last equilibrium, with its strength divided by `factor`.
Failure StabilitySearch::fail(double factor) {
  const GridShape& grid = scene_.grid;
  const double gravity = std::hypot(options_.gravity[0], options_.gravity[1], options_.gravity[2]);
  const double cell = std::min(grid.spacing, grid.layer_height);
  Failure failure{.factor = factor, .time = std::sqrt(2 * fall * cell / ((overload - 1) * gravity))};
  const double begun = held_.clock.time;
  const auto solver = resume_solver(
      weakened_scene(factor), falling_settings(options_, grid, factor, failure.time / fall_steps), device_, held_);
  double half = 0, end = 0;
  try {
    advance_to(*solver, begun + 0.5 * failure.time);
    half = solver->energies().kinetic;
    advance_to(*solver, begun + failure.time);
    end = solver->energies().kinetic;
  } catch (const NumericalError& error) {
    log_warning(fmt::format("the mass could not be followed as it fails, and no map shows it: {}", error.what()));
    return failure;
  }
  failure.moves = end > growing * half;
  const std::vector<double> way = ways(scene_, solver->ground(), held_.points, solver->state().points);
  failure.way = way_of_what_moves(way, scene_.points.volume);
  for (const double own : way) failure.shares.push_back(failure.way > 0 ? own / failure.way : 0);
  return failure;
}

/// How far the farthest point is from its seed [m].
double StabilitySearch::farthest(const SolverState& state) const {
  const auto now = positions(scene_.map, scene_.grid, make_terrain_tables(scene_.grid), state.points);
  double way = 0;
  for (std::size_t p = 0; p < now.size(); ++p)
    way = std::max(way, distance(now[p], seeds_[static_cast<std::size_t>(state.points.id[p])]));
  return way;
}

}  // namespace talus::solver
