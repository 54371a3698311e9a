// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The loop of a run: steps, events in time, the end. Files are its keeper's.
#pragma once

#include <chrono>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "common/stage/stage.hpp"
#include "solver/options/solve.hpp"
#include "solver/plan/plan.hpp"
#include "solver/run/products.hpp"
#include "solver/run/recorders/history.hpp"
#include "solver/run/stepper.hpp"

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
  bool record_due(double time, const RunMemory& passed) const {
    return just_after(time) >= at_count(passed.records, record_interval_) || time >= end_time_;
  }
  /// Whether a frame is due at `time` [s].
  bool frame_due(double time, const RunMemory& passed) const {
    return just_after(time) >= at_count(passed.frames, frame_interval_);
  }
  /// Whether a checkpoint is due at `time` [s].
  bool checkpoint_due(double time, const RunMemory& passed) const {
    return checkpoint_interval_ > 0 && time >= at_count(passed.checkpoints + 1, checkpoint_interval_);
  }
  bool ends_between_frames(double time, const RunMemory& passed) const {
    return time > just_after(at_count(passed.frames - 1, frame_interval_));
  }
  /// Whether the next pulse of the inflows is due at `time` [s].
  bool pulse_due(double time, const RunMemory& passed) const {
    return expects_pulses(passed) && just_after(time) >= pulses_[static_cast<std::size_t>(passed.pulses)];
  }
  bool expects_pulses(const RunMemory& passed) const { return passed.pulses < std::ssize(pulses_); }
  double end_time() const { return end_time_; }  ///< [s]

 private:
  /// The time from which an event counts as a later one: events a rounding apart are one, for no step may be asked to
  /// go from one to the other.
  static double just_after(double time) { return time * (1 + 1e-12); }
  static double at_count(std::int64_t count, double interval) { return static_cast<double>(count) * interval; }

  double frame_interval_, record_interval_, checkpoint_interval_, end_time_;  ///< [s]
  std::vector<double> changes_;                                               ///< of walls and loads [s]
  std::vector<double> pulses_;                                                ///< of inflows [s]
};

/// The points of a scene with the elastic state of the mass at rest under its own weight, held at its bed, after
/// `gravity_loading_steps` quasi-static steps. Throws NumericalError when a step does not converge.
ParticleState loaded_by_gravity(const Scene& scene, const SolveOptions& options, const AnyDevice& device);

/// The wall time of a run, that before an interruption included.
class RunTimer {
 public:
  void start() { started_ = WallClock::now(); }     ///< starts the clock
  void resume(double before) { before_ = before; }  ///< before: the wall time so far [s]
  /// The wall time so far [s].
  double seconds() const { return before_ + std::chrono::duration<double>(WallClock::now() - started_).count(); }

 private:
  using WallClock = std::chrono::steady_clock;
  WallClock::time_point started_ = WallClock::now();
  double before_ = 0;  ///< [s]
};

/// What is done with a run as it goes on.
class RunKeeper {
 public:
  virtual ~RunKeeper() = default;
  /// A frame is due at `time` [s].
  virtual void put_frame(double time) = 0;
  /// The history has a record at `time` [s]. The run ends here where the method returns false.
  virtual bool pass_record(double /*time*/) { return true; }
  virtual void pass_batch(const BatchReport& batch) = 0;  ///< a batch of steps has been taken
  /// There are more steps to take, and a run can go on from the state as it is: it may be written down, and the run
  /// stopped by an exception. `checkpoint_due`: the recipe asks for a checkpoint here.
  virtual void pass_whole_state(bool checkpoint_due) = 0;
};

/// The loop of a run, and the numbers that it records. Loops of the same domain and options take the same steps.
class RunLoop {
 public:
  /// The constructor prepares the recorders; no step is taken. It throws RecipeError.
  RunLoop(std::shared_ptr<const Plan> plan, const AnyDevice& device, HistoryUse use = HistoryUse::kept);
  RunLoop(const RunLoop&) = delete;
  RunLoop& operator=(const RunLoop&) = delete;

  void start();                                             ///< begins at the start of the scene
  void resume(const SolverState& state, RunMemory memory);  ///< goes on from a checkpoint's state
  /// The method steps to the end and returns why it stopped; `fresh`: from the start, whose events are passed first. It
  /// throws NumericalError, and what the keeper throws.
  std::string step_to_end(RunKeeper& keeper, bool fresh);

  const Plan& plan() const { return *plan_; }
  const SolveOptions& options() const { return plan_->options; }
  const Scene& scene() const { return plan_->scene; }
  const Stepper& stepper() const { return stepper_; }
  Stepper& stepper() { return stepper_; }
  const History& history() const { return history_; }
  const RunMemory& memory() const { return memory_; }
  RunMemory& memory() { return memory_; }
  double end_time() const { return schedule_.end_time(); }  ///< time at which the run ends at the latest [s]
  double mass_error() const;  ///< error of the mass by the last record, over the volume of the first [-]
  RunEnd end(const SolverState& state) const;  ///< end of the run; it refers to this loop and to `state`
  /// The method adds to a summary what this run tells of itself at its end.
  void measure(const RunEnd& end, RunSummary& summary) const;

 private:
  bool let_in(double time);
  void count(const BatchReport& batch);
  void pass_events(double time, RunKeeper& keeper);
  void record(double time, RunKeeper& keeper);
  void put_frame(double time, RunKeeper& keeper);
  bool calm() const;

  std::shared_ptr<const Plan> plan_;
  Schedule schedule_;
  Stepper stepper_;
  History history_;
  RunMemory memory_;
  StepWatch watch_;
  bool stopped_ = false;  ///< by the keeper
};

}  // namespace talus::solver
