// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The steps of a run: of one integrator, or with integrator = "auto" of whichever takes less work. The watch over them:
// a progress line, and the end of a run that loses a point or does not advance.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "common/stage/stage.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/integrator_choice.hpp"

namespace talus::solver {

/// The stepper owns the solver of a run, and builds it anew where another integrator takes less work.
class Stepper {
 public:
  /// The constructor keeps references to scene and options.
  Stepper(const Scene& scene, const SolveOptions& options, const AnyDevice& device);

  void begin(const SolverState& state);  ///< begins at a state: that of the scene's start, or of a checkpoint
  bool begun() const { return solver_ != nullptr; }  ///< whether begin() was called
  /// The method takes steps until `next_event` [s], the next sort or a failure, at most a batch. It throws
  /// NumericalError when no integrator can go on.
  BatchReport advance(double next_event);

  void add(const ParticleState& points);  ///< lets points enter the scene, between batches

  Solver& solver() { return *solver_; }  ///< solver that takes the steps; it must have begun
  const Solver& solver() const { return *solver_; }
  /// Whether it chooses between integrators as the run goes on.
  bool chooses() const { return choice_.has_value(); }
  double time() const { return time_; }                ///< [s]
  double over_cfl() const { return over_cfl_; }        ///< last step over the CFL step [-]
  const AnyDevice& device() const { return device_; }  ///< that takes the steps

 private:
  void build(const SolverState& state);
  BatchReport take_batch(double next_event);
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

/// The shortest step over the time that a run simulates [-]. That many take a GPU a day at least.
inline constexpr double least_step_share = 1e-10;
/// The share of the step at the start, mass at rest, below which steps have collapsed. A mass at five times the speed
/// of its waves, beyond which it is refused (plausible.cpp), takes steps a tenth as long.
inline constexpr double collapsed_share = 0.02;

class StepWatch {
 public:
  /// The constructor keeps references to scene and options.
  StepWatch(const Scene& scene, const SolveOptions& options);

  /// The method looks at what a batch ended with. It throws NumericalError where its steps do not advance: where time
  /// stands still, or a step is shorter than `least_step_share` of the time to simulate. It warns, once, where explicit
  /// steps have become shorter than `collapsed_share` of the first one.
  void look(const BatchReport& batch);

  double first_step() const { return first_step_; }  ///< of explicit steps, mass at rest [s]

 private:
  [[noreturn]] void refuse(const BatchReport& batch, double step) const;
  void warn_of_short_steps(const Clock& clock, double step);

  const GridShape& grid_;
  const SolveOptions& options_;
  double wave_speed_;  ///< of the fastest material [m/s]
  double first_step_;  ///< [s]
  bool warned_ = false;
};

/// How far a run has come.
struct RunProgress {
  double end_time;    ///< [s]
  double mass_error;  ///< volume in the domain and out of it over volume released, less one [-]
  double wall_time;   ///< since the start [s]
  bool may_rest;      ///< the run ends where the mass comes to rest, which may be before end_time
};

/// One line, what matters first: percent of the time, wall time still to come (to end_time; "at most" where the run may
/// end at rest), time, largest speed, step, step size, error of mass.
std::string progress_line(const Clock& clock, const RunProgress& progress);

/// This function throws the NumericalError that names the point whose state is not a number, or which is faster than
/// 1000 km/s, where it is, and the way out. `cfl`: the recipe's cfl.
[[noreturn]] void refuse_lost_point(const Clock& clock, const ParticleState& points, const MapGrid& map, double cfl);

}  // namespace talus::solver
