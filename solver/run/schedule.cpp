// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/schedule.hpp"

#include <algorithm>

namespace talus::solver {
namespace {

/// The time from which an event counts as a later one: events a rounding apart are one, for no step may be asked to go
/// from one to the other.
double just_after(double time) { return time * (1 + 1e-12); }

double at_count(std::int64_t count, double interval) { return static_cast<double>(count) * interval; }

}  // namespace

Schedule::Schedule(const SolveOptions& options, std::vector<double> pulses)
    : frame_interval_(options.frame_interval),
      record_interval_(options.history_interval),
      checkpoint_interval_(options.checkpoint_interval),
      end_time_(options.end_time),
      pulses_(std::move(pulses)) {
  for (const WallOptions& wall : options.walls) changes_.push_back(wall.to);
  for (const LoadOptions& load : options.loads) changes_.insert(changes_.end(), {load.from, load.to});
  if (options.shaking.acts()) changes_.push_back(options.shaking.start);
}

double Schedule::next_event(double time, const RunMemory& passed) const {
  double next =
      std::min({at_count(passed.frames, frame_interval_), at_count(passed.records, record_interval_), end_time_});
  for (const double change : changes_) {
    if (change > just_after(time)) next = std::min(next, change);
  }
  if (expects_pulses(passed)) next = std::min(next, pulses_[static_cast<std::size_t>(passed.pulses)]);
  return just_after(next) >= end_time_ ? end_time_ : next;
}

bool Schedule::record_due(double time, const RunMemory& passed) const {
  return just_after(time) >= at_count(passed.records, record_interval_) || time >= end_time_;
}

bool Schedule::frame_due(double time, const RunMemory& passed) const {
  return just_after(time) >= at_count(passed.frames, frame_interval_);
}

bool Schedule::pulse_due(double time, const RunMemory& passed) const {
  return expects_pulses(passed) && just_after(time) >= pulses_[static_cast<std::size_t>(passed.pulses)];
}

bool Schedule::checkpoint_due(double time, const RunMemory& passed) const {
  return checkpoint_interval_ > 0 && time >= at_count(passed.checkpoints + 1, checkpoint_interval_);
}

bool Schedule::ends_between_frames(double time, const RunMemory& passed) const {
  return time > just_after(at_count(passed.frames - 1, frame_interval_));
}

}  // namespace talus::solver
