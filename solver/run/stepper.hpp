// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of a run: of one integrator, or with integrator = "auto" of whichever takes less work.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/stage/stage.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/parallel/any_device.hpp"
#include "solver/plan/integrator_choice.hpp"

namespace talus::solver {

/// The stepper owns the solver of a run, and builds it anew where another integrator takes less work.
class Stepper {
 public:
  /// The constructor keeps references to scene and options.
  Stepper(const Scene& scene, const SolveOptions& options, const AnyDevice& device);

  /// The method begins at a state: that of the scene's start, or of a checkpoint.
  void begin(const SolverState& state);
  /// Whether begin() was called.
  bool begun() const { return solver_ != nullptr; }
  /// The method takes steps until `next_event` [s], the next sort or a failure, at most a batch. It throws
  /// NumericalError when no integrator can go on.
  BatchReport advance(double next_event);

  /// The method lets points enter the scene, between batches.
  void add(const ParticleState& points);

  /// The solver that takes the steps; it must have begun.
  Solver& solver() { return *solver_; }
  /// The solver that takes the steps, to read from.
  const Solver& solver() const { return *solver_; }
  /// Whether it chooses between integrators as the run goes on.
  bool chooses() const { return choice_.has_value(); }
  double time() const { return time_; }                ///< [s]
  double over_cfl() const { return over_cfl_; }        ///< last step over the CFL step [-]
  const AnyDevice& device() const { return device_; }  ///< that takes the steps

 private:
  void build(const SolverState& state);
  BatchReport take_batch(double next_event);
  BatchCount count_of(const BatchReport& batch) const;
  void hand_over();
  void log_decision(const std::string& taken_over = {});

  const Scene& scene_;
  const SolveOptions& options_;
  AnyDevice device_;
  std::optional<IntegratorChoice> choice_;  ///< integrator = "auto"
  BatchWork work_;                          ///< since the last sort
  double time_ = 0;                         ///< [s]
  long long step_ = 0;                      ///< number of the last step
  double over_cfl_ = 0;
  std::unique_ptr<Solver> solver_;
};

}  // namespace talus::solver
