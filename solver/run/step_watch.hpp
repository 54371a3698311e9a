// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The watch over the steps of a run: one that does not advance ends it, and one that has become far shorter is said.
#pragma once

#include "solver/integrator/scene.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// The shortest step over the time that a run simulates [-]. So many steps of the smallest scene would take a GPU a
/// day.
inline constexpr double least_step_share = 1e-10;
/// The share of the step at the start, mass at rest, below which steps have collapsed. A mass at five times the speed
/// of its waves, beyond which it is refused (plausible.cpp), takes steps a tenth as long.
inline constexpr double collapsed_share = 0.02;

/// The watch over the steps of a run.
class StepWatch {
 public:
  /// The constructor takes the step at the start from the scene.
  StepWatch(const Scene& scene, const SolveOptions& options);

  /// The method looks at what a batch ended with. It throws NumericalError where its steps do not advance: where time
  /// stands still, or a step is shorter than `least_step_share` of the time to simulate. It warns, once, where explicit
  /// steps have become shorter than `collapsed_share` of the first one.
  void look(const BatchReport& batch);

  double first_step() const { return first_step_; }  ///< of explicit steps, mass at rest [s]

 private:
  [[noreturn]] void refuse(const BatchReport& batch, double step) const;
  void warn_of_short_steps(const Clock& clock, double step);

  double spacing_;       ///< [m]
  double layer_height_;  ///< [m]
  double wave_speed_;    ///< of the fastest material [m/s]
  double modulus_;       ///< Young's, of the main material [Pa]
  double cfl_;
  double end_time_;    ///< [s]
  double first_step_;  ///< [s]
  bool warned_ = false;
};

}  // namespace talus::solver
