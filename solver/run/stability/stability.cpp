// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/stability/stability.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/stage/findings.hpp"
#include "solver/run/stability/weaken.hpp"
#include "solver/scene/make_scene.hpp"
#include "solver/scene/make_solver.hpp"

namespace talus::solver {

FactorBracket bracket_factor(const std::function<bool(double)>& holds, const FactorBounds& bounds,
                             FactorBracket known) {
  constexpr double longest = 1.25;
  double stride = known.low > 0 ? 1.02 : longest;
  FactorBracket found = known;
  const auto look_at = [&](double factor) { (holds(factor) ? found.low : found.high) = factor; };
  if (!(found.low > 0) && !std::isfinite(found.high)) look_at(1);
  if (found.low > 0) {
    while (!found.closed() && found.low < bounds.largest) {
      look_at(std::min(stride * found.low, bounds.largest));
      stride = std::min(stride * stride, longest);
    }
  } else {
    while (!found.closed() && found.high > bounds.least) look_at(std::max(found.high / stride, bounds.least));
  }
  while (found.closed() && found.high - found.low > bounds.tolerance * found.low) look_at(found.middle());
  return found;
}

namespace {

/// The factor under which the mass is let go, over the one that did not hold.
constexpr double overload = 1.02;
/// The way, in cells, that a mass falling under that part of its weight takes until its motion is looked at.
constexpr double fall = 0.1;
constexpr int fall_steps = 8;
/// The kinetic energy at the end over that at half time from which on the mass moves: a free one has four times as
/// much, one that finds a new equilibrium less than before.
constexpr double growing = 2;

/// The strength that the ground is given, over its own, for the way that it goes while nothing in it yields.
constexpr double sound = 1e3;
/// The largest way of an equilibrium, over that one: beyond it the ground has slumped into another shape (T40c).
constexpr double slumped = 10;
/// The share of the ground that goes farther than what counts as its way: some loose points at a rim are no slump.
constexpr double loose = 0.01;

/// The function steps to a time and adds up the iterations.
StepStats advance_to(Solver& solver, double time) {
  StepStats sum;
  solver.set_next_event(time);
  while (solver.clock().time < time) {
    stop_if_interrupted("looking for the factor of safety");
    const BatchReport batch = solver.advance();
    sum.newton += batch.stats.newton;
    sum.linear += batch.stats.linear;
    if (batch.clock.alarms.halt == failed)
      throw NumericalError(
          {"a point of the ground was lost", "its state is no number", "Look at the recipe's numbers"});
  }
  return sum;
}

double distance(const std::array<double, 3>& a, const std::array<double, 3>& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The ways of points between two states, by id [m].
std::vector<double> ways(const Scene& scene, const ParticleState& from, const ParticleState& to) {
  const auto before = positions(scene, from), after = positions(scene, to);
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
  if (!t.holds && t.way > 0)
    return fmt::format("strength / {:.4g}: no equilibrium of this shape (farthest point {:.3g} m from where it was)",
                       t.factor, t.way);
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
  seeds_ = positions(scene_, scene_.points);
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
  StabilityTrial trial;
  if (const auto state = rest(1 / sound, nullptr, trial)) most_way_ = slumped * way_of(*state, loose);
  const FactorBounds bounds{.tolerance = options_.stability.tolerance, .largest = options_.stability.largest_factor};
  found.factor = bracket_factor(holds, bounds);
  if (!found.factor.closed()) return found;
  const double failed = found.factor.high;
  StabilityTrial& last = *std::ranges::find(found.trials, failed, &StabilityTrial::factor);
  look_again(last);
  if (last.holds) {
    log_info(words(last));
    trusting_ = false;
    found.factor = bracket_factor(holds, bounds, {.low = failed});
  }
  if (found.factor.closed()) found.failure = std::move(nearest_);
  return found;
}

/// Brings gravity on, or goes on from the equilibrium `from` where given. The state is empty where none is found.
std::optional<SolverState> StabilitySearch::rest(double factor, const SolverState* from, StabilityTrial& trial) const {
  const Scene scene = weakened_scene(factor);
  SolverSettings settings = static_settings(options_, scene_, factor);
  if (from) settings.common.gravity_ramp = 0;
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

/// A trial: gravity brought on. The word of Newton's iterations is taken until it has been wrong once: what happens at
/// the limit itself is looked at when that is found.
StabilityTrial StabilitySearch::attempt(double factor) {
  StabilityTrial trial{.factor = factor};
  if (!keep(rest(factor, nullptr, trial), trial) && !trusting_) look_again(trial);
  return trial;
}

/// The method takes note of an equilibrium; it returns false where there is none.
bool StabilitySearch::keep(std::optional<SolverState> state, StabilityTrial& trial) {
  if (!state) return false;
  trial.way = way_of(*state, 0);
  trial.holds = way_of(*state, loose) <= most_way_;
  if (!trial.holds) return false;
  if (trial.factor > held_factor_) {
    held_ = std::move(*state);
    held_factor_ = trial.factor;
  }
  return true;
}

/// The second look at a trial that found no equilibrium: the way from the last one, then the mass let go.
void StabilitySearch::look_again(StabilityTrial& trial) {
  if (held_factor_ == 0 || trial.factor < held_factor_) return;
  if (keep(rest(trial.factor, &held_, trial), trial)) return;
  Failure failure = fail(overload * trial.factor);
  trial.holds = trial.by_motion = !failure.shares.empty() && !failure.moves;
  if (!trial.holds && !(nearest_.factor > 0 && nearest_.factor < failure.factor)) nearest_ = std::move(failure);
}

/// The mass let go from the last equilibrium, with its strength divided by `factor`.
Failure StabilitySearch::fail(double factor) {
  const GridShape& grid = scene_.grid;
  const double gravity = options_.gravity_size();
  const double cell = std::min(grid.spacing, grid.layer_height);
  Failure failure{.factor = factor, .time = std::sqrt(2 * fall * cell / ((overload - 1) * gravity))};
  const double begun = held_.clock.time;
  const auto solver = resume_solver(
      weakened_scene(factor), falling_settings(options_, scene_, factor, failure.time / fall_steps), device_, held_);
  double half = 0, end = 0;
  try {
    advance_to(*solver, begun + 0.5 * failure.time);
    half = solver->energies().kinetic;
    advance_to(*solver, begun + failure.time);
    end = solver->energies().kinetic;
  } catch (const NumericalError& error) {
    warn("failure-not-followed",
         fmt::format("the mass could not be followed as it fails, and no map shows it: {}", error.what()));
    return failure;
  }
  failure.moves = end > growing * half;
  log_detail(
      fmt::format("let go with strength / {:.4g}: kinetic energy {:.3g} J after {:.3g} s, {:.3g} J after {:.3g} s",
                  factor, half, 0.5 * failure.time, end, failure.time));
  const std::vector<double> way = ways(scene_, held_.points, solver->state().points);
  failure.way = way_of_what_moves(way, scene_.points.volume);
  for (const double own : way) failure.shares.push_back(failure.way > 0 ? own / failure.way : 0);
  return failure;
}

/// The way from their seeds that all points but this share of the volume stay below, or go at most [m].
double StabilitySearch::way_of(const SolverState& state, double share) const {
  const auto now = positions(scene_, state.points);
  std::vector<std::pair<double, double>> ways;  // with the volume that goes them
  double left = 0;
  for (std::size_t p = 0; p < now.size(); ++p) {
    ways.emplace_back(distance(now[p], seeds_[static_cast<std::size_t>(state.points.id[p])]), state.points.volume[p]);
    left += share * state.points.volume[p];
  }
  std::ranges::sort(ways, std::greater());
  for (const auto& [way, volume] : ways)
    if ((left -= volume) < 0) return way;
  return 0;
}

}  // namespace talus::solver
