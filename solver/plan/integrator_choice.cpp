// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/plan/integrator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace talus::solver {
namespace {

constexpr double column_step = 1.5;        // the work of a column-implicit step, in explicit ones
constexpr double newton_iteration = 10;    // of a Newton iteration
constexpr double linear_iteration = 0.65;  // of an iteration of the linear solver

constexpr double flow_cfl = 10;           // CFL steps over which motion is judged
constexpr double still = 1e-3;            // cells that nothing moves further than in them: at rest, or nearly
constexpr double stirs = 4;               // times as far: the flow begins again
constexpr double reach = 0.25;            // cells that a point may move in an implicit step
constexpr double shortest_implicit = 30;  // CFL steps; shorter implicit steps cannot pay
constexpr double first_price = 3;         // batches of the flow that the first trial is taken to cost
constexpr double hopeless = 4;            // the trial ends after a first step that took this many times the work
constexpr double trial_share = 0.05;      // of the work that trials may take
constexpr double better = 0.9;            // of the present work that an integrator may take to go on
constexpr double most_patience = 16;      // longer waits between trials than so many times the usual one are not made
constexpr int trial_steps = 4;            // the first of which pays for the change

const char* name_of(Integrator i) {
  if (i == Integrator::newmark) return "newmark";
  return i == Integrator::column_implicit ? "column-implicit" : "explicit";
}

}  // namespace

double work_of(Integrator flow, const BatchCount& count) {
  const double step = flow == Integrator::column_implicit ? column_step : 1;
  return step * static_cast<double>(count.steps) + newton_iteration * static_cast<double>(count.newton) +
         linear_iteration * static_cast<double>(count.linear);
}

void IntegratorChoice::Cost::add(const BatchWork& batch, double memory) {
  simulated = memory * simulated + batch.simulated;
  work = memory * work + batch.work;
}

void IntegratorChoice::measure(const BatchWork& batch) {
  speed_ = batch.speed;
  if (!(batch.wave_step > 0)) return;
  step_.wave = batch.wave_step;
  const double motion = batch.speed > 0 ? reach * cell_ / batch.speed : largest_step_;
  step_.suitable = std::min(motion, largest_step_);
}

/// Whether something moves too far for steps that see a state at rest.
bool IntegratorChoice::moves() const { return speed_ * flow_cfl * step_.wave > (flows() ? 1 : stirs) * still * cell_; }

bool IntegratorChoice::worth_trying() const {
  if (flows() && (moves() || step_.suitable < shortest_implicit * step_.wave)) return false;
  const bool changed = trial_.speed < 0 || speed_ > 4 * trial_.speed || speed_ < 0.25 * trial_.speed;
  const double price = trial_.work > 0 ? trial_.work : first_price * trial_.work_since / std::max(batches_, 1);
  return trial_.work_since > price / trial_share * (changed ? 1 : trial_.patience);
}

void IntegratorChoice::change_to(Integrator to) {
  current_ = to;
  batches_ = 0;
  if (!flows()) step_.implicit = step_.suitable;
}

void IntegratorChoice::begin_trial() {
  trial_.under_way = true;
  trial_.work = 0;
  trial_.speed = speed_;
  cost_of(other()) = {};
  change_to(other());
}

/// Ends a trial; it returns true when the trial's integrator stays.
bool IntegratorChoice::end_trial() {
  trial_.under_way = false;
  trial_.work_since = 0;
  const double tried = cost_of(current_).rate(), before = cost_of(other()).rate();
  const bool stays = tried < better * before;
  if (stays) {
    trial_.patience = 1;
    decision_ = fmt::format("{} steps from here on: the work of {:.3g} explicit steps a simulated second, not {:.3g}{}",
                            name_of(current_), tried, before,
                            flows() ? "" : fmt::format(", in steps of {:.3g} s", step_.implicit));
  } else {
    trial_.patience = std::min(2 * trial_.patience, most_patience);
    change_to(other());
  }
  return stays;
}

bool IntegratorChoice::follow_trial(const BatchWork& batch) {
  trial_.work += batch.work;
  const bool first = batches_ == 1;
  const bool is_hopeless = first && batch.work > hopeless * cost_of(other()).rate() * batch.simulated;
  if (!first || is_hopeless) cost_of(current_).add(batch, 1);
  return (is_hopeless || batches_ >= trial_steps) && !end_trial();
}

/// Takes up a length of implicit steps that has become another one; it returns true where it has.
bool IntegratorChoice::fit_step() {
  if (flows() || (step_.suitable <= 2 * step_.implicit && step_.suitable >= 0.5 * step_.implicit)) return false;
  step_.implicit = step_.suitable;
  return true;
}

bool IntegratorChoice::note(const BatchWork& batch) {
  measure(batch);
  ++batches_;
  if (!flows() && moves()) {
    trial_.under_way = false;
    trial_.work_since = 0;
    change_to(flow_);
    decision_ = fmt::format("{} steps from here on: points move, at {:.2g} m/s", name_of(flow_), speed_);
    return true;
  }
  if (trial_.under_way) return follow_trial(batch);
  trial_.work_since += batch.work;
  cost_of(current_).add(batch, 0.9);
  if (worth_trying()) {
    begin_trial();
    return true;
  }
  return fit_step();
}

void IntegratorChoice::note_failure(double work) {
  trial_.work += work;
  trial_.under_way = false;
  trial_.work_since = 0;
  trial_.patience = std::min(4 * trial_.patience, most_patience);
  change_to(flow_);
  decision_ = fmt::format("{} steps from here on: an implicit one found no solution", name_of(flow_));
}

std::string IntegratorChoice::take_decision() { return std::exchange(decision_, {}); }

}  // namespace talus::solver
