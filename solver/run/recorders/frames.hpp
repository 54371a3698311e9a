// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of frames (points and thickness of the whole map at chosen times), which are packed while the run goes on.
#pragma once

#include <deque>
#include <filesystem>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/run/run_file.hpp"
#include "common/stage/context.hpp"
#include "common/stage/signals.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// Work beside the run; few pieces wait at a time, since each holds a copy of the points.
class SideWork {
 public:
  /// The method has `work` done after the pieces before, and ahead of it, beside them, `alone`; it throws what one of
  /// them threw, which ends them all.
  void start(std::function<void()> work, std::function<void()> alone = {}) {
    constexpr std::size_t most = 3;
    while (pieces_.size() >= most) wait_for_first();
    const auto before = pieces_.empty() ? std::shared_future<void>() : pieces_.back();
    auto piece = [before, work = std::move(work), alone = std::move(alone), &here = context()] {
      const CrashStack room;
      const BindContext bind(here);
      if (alone) alone();
      if (before.valid()) before.get();
      work();
    };
    pieces_.push_back(std::async(std::launch::async, std::move(piece)).share());
  }
  /// The method waits until nothing is left to do; it throws what a piece threw.
  void settle() {
    while (!pieces_.empty()) wait_for_first();
  }

 private:
  void wait_for_first() {
    const auto first = pieces_.front();
    pieces_.pop_front();
    first.get();
  }
  std::deque<std::shared_future<void>> pieces_;  ///< the destructor of the last holder of each waits
};

/// The points of a scene at `time` [s], in map coordinates.
PointFrame point_frame(const Scene& scene, const SolveOptions& options, double time, const ParticleState& points);

/// The recorder of frames. They go into the file that is to become run.h5. A checkpoint counts on those before it: what
/// was recorded since the one before becomes a file of its own, in a folder for every run, so that those of an older
/// run stay until they are dropped.
class FrameRecorder {
 public:
  /// The constructor keeps references to scene and options. `store`: the folder for frames that checkpoints count on.
  FrameRecorder(const Scene& scene, const SolveOptions& options, std::filesystem::path store, std::filesystem::path run)
      : scene_(scene), options_(options), store_(std::move(store)), file_(std::move(run)) {}

  /// From now on frames are those of this run; each file carries its id.
  void belong_to(const std::string& run_id) {
    run_id_ = run_id;
    saved_ = 0;
  }
  /// Takes the state at once; the frame is packed and written while the run goes on. It throws what that threw for a
  /// frame before: DataError (disk full, not writable).
  void put(double time, Solver& solver);
  /// The method puts all `count` frames so far on disk for good. It throws DataError.
  void save(std::int64_t count);
  /// The method throws DataError unless the files of frames 0 .. count-1 are there, and goes on behind them.
  void go_on_after(std::int64_t count);
  /// The method returns the file that becomes run.h5, with all `count` frames; before each file of them that it takes
  /// over it calls `pause`, which may throw. It throws DataError: one is missing, damaged or another run's.
  RunWriter& whole(std::int64_t count, const std::function<void()>& pause);
  void drop_others() const;  ///< drops saved frames of other runs

 private:
  std::filesystem::path saved_file(std::int64_t first) const;
  ParticleState spare_state();  ///< one of a frame that has been packed, if there is one
  h5::File open_saved(std::int64_t first) const;

  const Scene& scene_;
  const SolveOptions& options_;
  std::filesystem::path store_, file_;
  std::string run_id_;
  std::int64_t saved_ = 0;          ///< frames in files of their own
  std::unique_ptr<RunWriter> run_;  ///< the frames since, once there is one
  std::mutex spare_guard_;
  std::vector<ParticleState> spare_;  ///< new memory for every frame takes longer than to fill it
  SideWork writing_;                  ///< last: what it does needs the rest
};

}  // namespace talus::solver
