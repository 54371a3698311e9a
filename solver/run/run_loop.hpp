// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The loop of a run: steps, events in time, the end. Files are its keeper's.
#pragma once

#include <chrono>
#include <memory>
#include <string>

#include "solver/parallel/any_device.hpp"
#include "solver/plan/plan.hpp"
#include "solver/run/products.hpp"
#include "solver/run/recorders/checkpoint.hpp"
#include "solver/run/recorders/history.hpp"
#include "solver/run/schedule.hpp"
#include "solver/run/step_watch.hpp"
#include "solver/run/stepper.hpp"

namespace talus::solver {

/// The wall time of a run, that before an interruption included.
class RunTimer {
 public:
  /// The method starts the clock.
  void start() { started_ = WallClock::now(); }
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
  /// A frame is due at `time` [s], the `number`th from 0.
  virtual void put_frame(double time, std::int64_t number) = 0;
  /// The history has a record at `time` [s]. The run ends here where the method returns false.
  virtual bool pass_record(double /*time*/) { return true; }
  /// A batch of steps has been taken.
  virtual void pass_batch(const BatchReport& batch) = 0;
  /// There are more steps to take, and a run can go on from the state as it is: it may be written down, and the run
  /// stopped by an exception. `checkpoint_due`: the recipe asks for a checkpoint here.
  virtual void pass_whole_state(bool checkpoint_due) = 0;
};

/// The loop of a run, and the numbers that it records. Two loops of the same domain and options take the same steps,
/// whoever keeps them.
class RunLoop {
 public:
  /// The constructor prepares the recorders; no step is taken. It throws RecipeError.
  RunLoop(std::shared_ptr<const Plan> plan, const AnyDevice& device, HistoryUse use = HistoryUse::kept);
  RunLoop(const RunLoop&) = delete;
  RunLoop& operator=(const RunLoop&) = delete;

  /// The method begins at the start of the scene.
  void start();
  /// The method goes on from a checkpoint's state.
  void resume(const SolverState& state, RunMemory memory);
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
  /// The time at which the run ends at the latest [s].
  double end_time() const { return schedule_.end_time(); }
  /// The error of the mass by the last record, over the volume of the first [-].
  double mass_error() const;
  /// The end of the run; it refers to this loop and to `state`.
  RunEnd end(const SolverState& state) const;
  /// The method adds to a summary what this run tells of itself at its end.
  void measure(const RunEnd& end, RunSummary& summary) const;

 private:
  bool let_in(double time);
  void pass_whole_state(RunKeeper& keeper);
  bool left_empty() const;
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
