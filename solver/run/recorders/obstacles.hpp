// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of obstacles: the impulse that each was given.
#pragma once

#include "solver/options/solve.hpp"
#include "solver/run/recorders/recorder.hpp"

namespace talus::solver {

/// The recorder of the impulse of the mass on every obstacle since the start [N s].
class ObstacleRecorder : public TableRecorder<Vec3<double>> {
 public:
  explicit ObstacleRecorder(const SolveOptions& options);
  /// The lines on every obstacle: the impulse in all, and the largest mean force between two records and its time.
  void conclude(const RunHistory& history) const override;

 protected:
  std::vector<Vec3<double>> samples(const Instant& now) const override { return now.solver.obstacle_impulses(); }

 private:
  std::vector<std::string> names_;
  double interval_;  ///< between records [s]
};

}  // namespace talus::solver
