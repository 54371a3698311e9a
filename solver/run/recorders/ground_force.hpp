// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of the force of the slide on the ground, as seismologists invert for it.
#pragma once

#include "solver/options/solve.hpp"
#include "solver/run/recorders/recorder.hpp"

namespace talus::solver {

/// The recorder of the force that the slide puts on the ground beyond its weight at rest: -dP/dt, the change of the
/// momentum P of the whole mass turned round (Kanamori & Given 1982; Ekström & Stark 2013,
/// doi 10.1126/science.1232887) [N]. Each row holds the mean since the row before; the first is 0. Bed, walls and
/// obstacles are the ground together. A row in whose time matter left the domain holds NaN: the momentum that left with
/// it is not known.
class GroundForceRecorder : public Recorder {
 public:
  /// Whether the momentum says what the ground was given: not where loads pull at the mass, and not where the ground
  /// itself is shaken.
  static bool measures(const SolveOptions& options) { return options.loads.empty() && !options.shaking.acts(); }

  /// The method adds a column for each direction.
  void add_columns(RunHistory& history) const override;
  /// The method appends the force since the row before, whose momentum the history holds.
  void record(const Instant& now, RunHistory& history) override;
  /// The line on the largest force.
  void conclude(const RunHistory& history) const override;
};

}  // namespace talus::solver
