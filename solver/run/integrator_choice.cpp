#include "solver/run/integrator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace talus::solver {
namespace {

constexpr double flow_cfl = 10;       // CFL steps of an implicit step in a flow
constexpr double still = 1e-3;        // cells that nothing moves further than in such a step: at rest, or nearly
constexpr double reach = 0.25;        // cells that a point may move in an implicit step
constexpr double least_cfl = 3;       // shorter implicit steps cannot pay
constexpr double first_price = 3;     // batches of explicit steps that the first trial is taken to cost
constexpr double hopeless = 4;        // the trial ends after a first step that cost this many times as much
constexpr double trial_share = 0.05;  // of the wall time that trials may take
constexpr double better = 0.9;        // of the present cost that an integrator may have to take over
constexpr double most_patience = 16;  // longer waits between trials than so many times the usual one are not made

const char* name_of(Integrator i) { return i == Integrator::explicit_ ? "explicit" : "newmark"; }

}  // namespace

void IntegratorChoice::Cost::add(const BatchCost& batch, double memory) {
  simulated = memory * simulated + batch.simulated;
  wall = memory * wall + batch.wall;
}

void IntegratorChoice::measure(const BatchCost& batch) {
  speed_ = batch.speed;
  if (!(batch.wave_step > 0)) return;
  step_.wave = batch.wave_step;
  const double flow = flow_cfl * batch.wave_step;
  const double motion = batch.speed > 0 ? reach * cell_ / batch.speed : largest_step_;
  step_.suitable = std::min({batch.speed * flow > still * cell_ ? flow : largest_step_, motion, largest_step_});
}

bool IntegratorChoice::worth_trying() const {
  if (current_ == Integrator::explicit_ && step_.suitable < least_cfl * step_.wave) return false;
  const bool changed = trial_.speed < 0 || speed_ > 4 * trial_.speed || speed_ < 0.25 * trial_.speed;
  const double price = trial_.wall > 0 ? trial_.wall : first_price * trial_.wall_since / std::max(batches_, 1);
  return trial_.wall_since > price / trial_share * (changed ? 1 : trial_.patience);
}

void IntegratorChoice::change_to(Integrator to) {
  current_ = to;
  batches_ = 0;
  if (to == Integrator::newmark) step_.implicit = step_.suitable;
}

void IntegratorChoice::begin_trial() {
  trial_.under_way = true;
  trial_.wall = 0;
  trial_.speed = speed_;
  cost_of(other()) = {};
  change_to(other());
}

/// The method ends a trial; it returns true when the trial's integrator stays.
bool IntegratorChoice::end_trial() {
  trial_.under_way = false;
  trial_.wall_since = 0;
  const double tried = cost_of(current_).rate(), before = cost_of(other()).rate();
  const bool stays = tried < better * before;
  if (stays) {
    trial_.patience = 1;
    decision_ = fmt::format(
        "{} steps from here on: {:.3g} s of wall time per simulated second instead of {:.3g} s{}", name_of(current_),
        tried, before, current_ == Integrator::newmark ? fmt::format(", in steps of {:.3g} s", step_.implicit) : "");
  } else {
    trial_.patience = std::min(2 * trial_.patience, most_patience);
    change_to(other());
  }
  return stays;
}

bool IntegratorChoice::note(const BatchCost& batch) {
  measure(batch);
  ++batches_;
  if (trial_.under_way) {
    trial_.wall += batch.wall;
    if (batches_ > 1) cost_of(current_).add(batch, 1);  // the first one pays for the change
    if (batches_ == 1 && batch.wall > hopeless * cost_of(other()).rate() * batch.simulated) {
      cost_of(current_).add(batch, 1);
      return !end_trial();
    }
    return batches_ >= trial_batches() && !end_trial();
  }
  trial_.wall_since += batch.wall;
  cost_of(current_).add(batch, 0.9);
  if (worth_trying()) {
    begin_trial();
    return true;
  }
  if (current_ == Integrator::newmark &&
      (step_.suitable > 2 * step_.implicit || step_.suitable < 0.5 * step_.implicit)) {
    step_.implicit = step_.suitable;
    return true;
  }
  return false;
}

void IntegratorChoice::note_failure(double wall) {
  trial_.wall += wall;
  trial_.under_way = false;
  trial_.wall_since = 0;
  trial_.patience = std::min(4 * trial_.patience, most_patience);
  change_to(Integrator::explicit_);
  decision_ = "explicit steps from here on: an implicit one found no solution";
}

std::string IntegratorChoice::take_decision() { return std::exchange(decision_, {}); }

}  // namespace talus::solver
