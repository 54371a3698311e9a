// integrator = "auto": explicit or Newmark steps, whichever take less wall time per simulated time, found by trying
// both now and then.
#pragma once

#include <string>

#include "solver/options/solve.hpp"

namespace talus::solver {

/// The cost of the steps from one sort of the points to the next.
struct BatchCost {
  double simulated = 0, wall = 0;  ///< [s]
  double wave_step = 0;            ///< the CFL step [s]
  double speed = 0;                ///< of the fastest point [m/s]
};

/// The choice of `integrator = "auto"`: it runs one integrator, tries the other for a few steps, and goes on with the
/// cheaper. Trials take no more than a twentieth of the time, less where they keep turning out the same.
class IntegratorChoice {
 public:
  /// `cell` is the smaller of spacing and layer height [m]; `largest_step` [s].
  IntegratorChoice(double cell, double largest_step) : cell_(cell), largest_step_(largest_step) {}

  /// The integrator to run.
  Integrator current() const { return current_; }
  /// The length of implicit steps from here on: ten CFL steps in a flow, where longer ones miss its way; at rest, or
  /// nearly, as long as nothing moves by more than a quarter of a cell [s].
  double implicit_step() const { return step_.implicit; }

  /// The method counts the cost of a batch. It returns true when the solver must be built anew: for the other
  /// integrator, or for implicit steps of another length.
  bool note(const BatchCost& batch);
  /// The method goes back to explicit steps after an implicit one that failed beyond rescue; `wall`: what it took [s].
  void note_failure(double wall);

  /// The decision since the last call, with its reason; empty when there was none.
  std::string take_decision();

 private:
  struct Cost {
    double simulated = 0, wall = 0;
    /// The method adds a batch; `memory` is the weight that earlier ones keep [-].
    void add(const BatchCost& batch, double memory);
    /// The wall time per simulated time [-]; 0 before the first batch.
    double rate() const { return simulated > 0 ? wall / simulated : 0; }
  };

  Integrator other() const { return current_ == Integrator::explicit_ ? Integrator::newmark : Integrator::explicit_; }
  Cost& cost_of(Integrator i) { return i == Integrator::explicit_ ? explicit_ : implicit_; }
  int trial_batches() const { return current_ == Integrator::explicit_ ? 3 : 4; }
  void measure(const BatchCost& batch);
  bool worth_trying() const;
  void begin_trial();
  bool end_trial();
  void change_to(Integrator to);

  /// A trial of the other integrator, the one under way or the last one.
  struct Trial {
    bool under_way = false;
    double wall = 0;        ///< what it took [s]
    double speed = -1;      ///< of the fastest point when it began [m/s]; negative: there was none
    double wall_since = 0;  ///< its end [s]
    double patience = 1;    ///< grows while trials change nothing
  };
  /// The lengths of steps [s].
  struct StepLengths {
    double implicit = 0;  ///< taken now
    double suitable = 0;  ///< that the flow asks for
    double wave = 0;      ///< the CFL step
  };

  double cell_, largest_step_;
  Integrator current_ = Integrator::explicit_;
  Cost explicit_, implicit_;
  Trial trial_;
  StepLengths step_;
  int batches_ = 0;   ///< since the last change
  double speed_ = 0;  ///< of the fastest point [m/s]
  std::string decision_;
};

}  // namespace talus::solver
