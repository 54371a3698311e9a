#include "solver/run/integrator_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace talus::solver {
namespace {

constexpr double flow_cfl = 10;    // CFL steps of an implicit step in a flow
constexpr double still = 1e-3;     // cells that nothing moves further than in such a step: at rest, or nearly
constexpr double reach = 0.25;     // cells that a point may move in an implicit step
constexpr double least_cfl = 3;    // shorter implicit steps cannot pay
constexpr double first_price = 3;  // batches of explicit steps that the first trial is taken to cost
constexpr double hopeless = 4;     // times as dear: the trial ends after its first step

const char* name_of(Integrator i) { return i == Integrator::explicit_ ? "explicit" : "newmark"; }

}  // namespace

void IntegratorChoice::Cost::add(const BatchCost& batch, double memory) {
  simulated = memory * simulated + batch.simulated;
  wall = memory * wall + batch.wall;
}

void IntegratorChoice::measure(const BatchCost& batch) {
  speed_ = batch.speed;
  if (!(batch.wave_step > 0)) return;
  wave_step_ = batch.wave_step;
  const double flow = flow_cfl * batch.wave_step;
  const double motion = batch.speed > 0 ? reach * cell_ / batch.speed : largest_step_;
  wanted_step_ = std::min({batch.speed * flow > still * cell_ ? flow : largest_step_, motion, largest_step_});
}

bool IntegratorChoice::worth_trying() const {
  if (current_ == Integrator::explicit_ && wanted_step_ < least_cfl * wave_step_) return false;
  const bool changed = speed_at_trial_ < 0 || speed_ > 4 * speed_at_trial_ || speed_ < 0.25 * speed_at_trial_;
  const double price = trial_wall_ > 0 ? trial_wall_ : first_price * wall_since_ / std::max(batches_, 1);
  return wall_since_ > price / trial_share * (changed ? 1 : patience_);
}

void IntegratorChoice::turn_to(Integrator to) {
  current_ = to;
  batches_ = 0;
  if (to == Integrator::newmark) implicit_step_ = wanted_step_;
}

void IntegratorChoice::begin_trial() {
  trying_ = true;
  trial_wall_ = 0;
  speed_at_trial_ = speed_;
  cost_of(other()) = {};
  turn_to(other());
}

/// True when the trial's integrator stays.
bool IntegratorChoice::end_trial() {
  trying_ = false;
  wall_since_ = 0;
  const double tried = cost_of(current_).rate(), before = cost_of(other()).rate();
  const bool stays = tried < better * before;
  if (stays) {
    patience_ = 1;
    news_ = fmt::format("{} steps from here on: {:.3g} s of wall time per simulated second instead of {:.3g} s{}",
                        name_of(current_), tried, before,
                        current_ == Integrator::newmark ? fmt::format(", in steps of {:.3g} s", implicit_step_) : "");
  } else {
    patience_ = std::min(2 * patience_, most_patience);
    turn_to(other());
  }
  return stays;
}

bool IntegratorChoice::note(const BatchCost& batch) {
  measure(batch);
  ++batches_;
  if (trying_) {
    trial_wall_ += batch.wall;
    if (batches_ > 1) cost_of(current_).add(batch, 1);  // the first one pays for the change
    if (batches_ == 1 && batch.wall > hopeless * cost_of(other()).rate() * batch.simulated) {
      cost_of(current_).add(batch, 1);
      return !end_trial();
    }
    return batches_ >= trial_batches() && !end_trial();
  }
  wall_since_ += batch.wall;
  cost_of(current_).add(batch, 0.9);
  if (worth_trying()) {
    begin_trial();
    return true;
  }
  if (current_ == Integrator::newmark && (wanted_step_ > 2 * implicit_step_ || wanted_step_ < 0.5 * implicit_step_)) {
    implicit_step_ = wanted_step_;
    return true;
  }
  return false;
}

void IntegratorChoice::note_failure(double wall) {
  trial_wall_ += wall;
  trying_ = false;
  wall_since_ = 0;
  patience_ = std::min(4 * patience_, most_patience);
  turn_to(Integrator::explicit_);
  news_ = "explicit steps from here on: an implicit one found no solution";
}

std::string IntegratorChoice::news() { return std::exchange(news_, {}); }

}  // namespace talus::solver
