// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorders of forces: of the slide on the ground, as seismologists invert for it, and of the mass on obstacles.
#pragma once

#include "solver/options/solve.hpp"
#include "solver/run/recorders/history.hpp"

namespace talus::solver {

/// The recorder of the force that the slide puts on the ground beyond its weight at rest: -dP/dt, the change of the
/// momentum P of the whole mass turned round (Kanamori & Given 1982; Ekström & Stark 2013, doi 10.1126/science.1232887)
/// [N]. Each row holds the mean since the row before; the first is 0. Bed, walls and obstacles are the ground together.
/// A row in whose time matter left the domain holds NaN: the momentum that left with it is not known.
class GroundForceRecorder : public Recorder {
 public:
  /// Whether the momentum says what the ground was given: not where loads pull at the mass or the ground is shaken.
  static bool measures(const SolveOptions& options) { return options.loads.empty() && !options.shaking.acts(); }

  void add_columns(RunHistory& history) const override;  ///< adds a column for each direction
  /// The method appends the force since the row before, whose momentum the history holds.
  void record(const Instant& now, RunHistory& history) override;
  void conclude(const RunHistory& history) const override;  ///< line on the largest force
};

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
