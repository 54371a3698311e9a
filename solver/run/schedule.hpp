// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// When a run records, writes frames and checkpoints, and what times its steps must meet.
#pragma once

#include <iterator>
#include <utility>
#include <vector>

#include "solver/options/solve.hpp"
#include "solver/run/recorders/checkpoint.hpp"

namespace talus::solver {

/// The events of a run in simulated time, from the recipe. RunMemory keeps how many have passed.
class Schedule {
 public:
  /// `pulses`: the times at which material enters, in order [s].
  explicit Schedule(const SolveOptions& options, std::vector<double> pulses = {});

  /// The next time after `time` that no step may go over [s]: a frame, a record, a wall or load that comes or goes, a
  /// pulse that enters, the end.
  double next_event(double time, const RunMemory& passed) const;
  /// Whether a row of the history is due at `time` [s].
  bool record_due(double time, const RunMemory& passed) const;
  /// Whether a frame is due at `time` [s].
  bool frame_due(double time, const RunMemory& passed) const;
  /// Whether a checkpoint is due at `time` [s].
  bool checkpoint_due(double time, const RunMemory& passed) const;
  /// Whether a run that ends at `time` ends between two frames.
  bool ends_between_frames(double time, const RunMemory& passed) const;
  /// Whether the next pulse of the inflows is due at `time` [s].
  bool pulse_due(double time, const RunMemory& passed) const;
  /// Whether more pulses are to come.
  bool expects_pulses(const RunMemory& passed) const { return passed.pulses < std::ssize(pulses_); }
  double end_time() const { return end_time_; }  ///< [s]

 private:
  double frame_interval_, record_interval_, checkpoint_interval_, end_time_;  ///< [s]
  std::vector<double> changes_;                                               ///< of walls and loads [s]
  std::vector<double> pulses_;                                                ///< of inflows [s]
};

}  // namespace talus::solver
