// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of frames (points and thickness of the whole map at chosen times), and their files beside the run.
#pragma once

#include <filesystem>
#include <functional>
#include <future>
#include <utility>

#include "common/run/run_file.hpp"
#include "common/stage/context.hpp"
#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"

namespace talus::solver {

/// Work beside the run, one piece at a time.
class SideWork {
 public:
  /// The method starts `work` once the piece before is done; it throws what that threw.
  void start(std::function<void()> work) {
    settle();
    running_ = std::async(std::launch::async, [work = std::move(work), &here = context()] {
      const BindContext bind(here);
      work();
    });
  }
  /// The method waits until nothing is left to do; it throws what the last piece threw.
  void settle() {
    if (running_.valid()) running_.get();
  }

 private:
  std::future<void> running_;  ///< its destructor waits
};

/// A folder of frames by number, in a folder for every run, so that those of an older run stay until they are dropped.
class FrameStore {
 public:
  explicit FrameStore(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// From now on frames are those of this run; each carries its id. Empty: of a version that knew no ids.
  void belong_to(const std::string& run_id) { run_id_ = run_id; }
  void clear();              ///< drops all frames, of whichever run
  void drop_others() const;  ///< drops the frames of other runs
  /// The method writes one frame, aside and renamed at the end. It throws DataError (disk full, not writable).
  void put(std::int64_t number, const PointFrame& points, const MapGrid& grid, const std::vector<double>& thickness);
  /// The method throws DataError unless frames 0 .. count-1 are there.
  void expect(std::int64_t count) const;
  /// The method hands frame `number` to the run file. It throws DataError when it is missing or another run's.
  void append_to(RunWriter& run, std::int64_t number, const MapGrid& grid) const;

 private:
  std::filesystem::path file(std::int64_t number) const;
  std::filesystem::path folder_;
  std::string run_id_ = {};
};

/// The points of a scene at `time` [s], in map coordinates.
PointFrame point_frame(const Scene& scene, const SolveOptions& options, double time, const ParticleState& points);

/// The recorder of frames, which are written while the run goes on.
class FrameRecorder : public FrameStore {
 public:
  /// The constructor keeps references to scene and options. Frames go to the folder `store` until the end of the run.
  FrameRecorder(const Scene& scene, const SolveOptions& options, std::filesystem::path store);

  /// Takes the state at once; the file is written while the run goes on. It throws what writing the frame before threw.
  void put(double time, std::int64_t number, Solver& solver);
  /// The method waits until every frame is on disk. It throws what writing the last one threw. HDF5 does one thing at a
  /// time: this is called before another file is written.
  void settle() { writing_.settle(); }
  void append_to(RunWriter& run, std::int64_t number) const { FrameStore::append_to(run, number, scene_.map); }

 private:
  const Scene& scene_;
  const SolveOptions& options_;
  SideWork writing_;  ///< last: what it does needs the rest
};

}  // namespace talus::solver
