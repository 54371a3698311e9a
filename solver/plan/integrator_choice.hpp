// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// integrator = "auto" as the run goes on: steps of a flow, or Newmark's where all is at rest and they take less work.
#pragma once

#include <string>

#include "solver/options/scheme.hpp"

namespace talus::solver {

/// What the steps from one sort of the points to the next did.
struct BatchWork {
  double simulated = 0;  ///< [s]
  double work = 0;       ///< in explicit steps, see work_of()
  double wave_step = 0;  ///< the CFL step [s]
  double speed = 0;      ///< of the fastest point [m/s]
};

struct BatchCount {
  long long steps = 0;   ///< steps of a flow
  long long newton = 0;  ///< Newton iterations, of attempts that failed too
  long long linear = 0;  ///< iterations of the linear solver
};

/// The work of a batch, in explicit steps: what kernels read and write, not what a clock says, so that a recipe takes
/// the same steps on every machine. A column-implicit step counts as 1.5, a Newton iteration as 10, one of the linear
/// solver as 0.65 (docs/notes/integrators.md).
double work_of(Integrator flow, const BatchCount& count);

/// The choice of `integrator = "auto"`: steps of the flow while anything moves. Where nothing would move by a
/// thousandth of a cell in ten CFL steps, Newmark takes four steps as long as `largest_step_s` allows; whichever takes
/// less work per simulated time (by a tenth at least) goes on. Trials take no more than a twentieth of the work, less
/// where they keep turning out the same. What begins to move ends Newmark's steps.
class IntegratorChoice {
 public:
  /// `cell` is the smaller of spacing and layer height [m]; `largest_step` [s]; `flow` takes the steps of a flow.
  IntegratorChoice(double cell, double largest_step, Integrator flow)
      : cell_(cell), largest_step_(largest_step), flow_(flow), current_(flow) {}

  Integrator current() const { return current_; }
  /// The length of implicit steps from here on: as long as nothing moves by more than a quarter of a cell [s].
  double implicit_step() const { return step_.implicit; }

  /// The method counts the work of a batch. It returns true when the solver must be built anew: for the other
  /// integrator, or for implicit steps of another length.
  bool note(const BatchWork& batch);
  /// Goes back to steps of the flow after an implicit one that failed beyond rescue; `work`: what it took.
  void note_failure(double work);

  /// The decision since the last call, with its reason; empty when there was none.
  std::string take_decision();

 private:
  struct Cost {
    double simulated = 0, work = 0;
    /// Adds a batch; `memory` is the weight that earlier ones keep [-].
    void add(const BatchWork& batch, double memory);
    /// The work per simulated time [1/s]; 0 before the first batch.
    double rate() const { return simulated > 0 ? work / simulated : 0; }
  };

  bool flows() const { return current_ == flow_; }
  Integrator other() const { return flows() ? Integrator::newmark : flow_; }
  Cost& cost_of(Integrator i) { return i == flow_ ? cost_of_flow_ : cost_at_rest_; }
  void measure(const BatchWork& batch);
  bool moves() const;
  bool worth_trying() const;
  void begin_trial();
  bool end_trial();
  bool follow_trial(const BatchWork& batch);
  bool fit_step();
  void change_to(Integrator to);

  /// A trial of the other integrator, the one under way or the last one.
  struct Trial {
    bool under_way = false;
    double work = 0;        ///< what it took
    double speed = -1;      ///< of the fastest point when it began [m/s]; negative: there was none
    double work_since = 0;  ///< its end
    double patience = 1;    ///< grows while trials change nothing
  };
  /// The lengths of steps [s].
  struct StepLengths {
    double implicit = 0;  ///< taken now
    double suitable = 0;  ///< that the state asks for
    double wave = 0;      ///< the CFL step
  };

  double cell_, largest_step_;
  Integrator flow_, current_;
  Cost cost_of_flow_, cost_at_rest_;
  Trial trial_;
  StepLengths step_;
  int batches_ = 0;   ///< since the last change
  double speed_ = 0;  ///< of the fastest point [m/s]
  std::string decision_;
};

}  // namespace talus::solver
