// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of frames: the points and the thickness of the whole map at chosen times.
#pragma once

#include <filesystem>

#include "solver/integrator/solver.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/recorders/frame_store.hpp"
#include "solver/run/recorders/side_work.hpp"

namespace talus::solver {

/// The points of a scene at `time` [s], in map coordinates.
PointFrame point_frame(const Scene& scene, const SolveOptions& options, double time, const ParticleState& points);

/// The recorder of frames, which are written while the run goes on.
class FrameRecorder {
 public:
  /// The constructor keeps references to scene and options. Frames go to the folder `store` until the end of the run.
  FrameRecorder(const Scene& scene, const SolveOptions& options, std::filesystem::path store);

  /// From now on frames are those of this run; each carries its id.
  void belong_to(const std::string& run_id) { store_.belong_to(run_id); }
  void clear() { store_.clear(); }              ///< drops all frames, of whichever run
  void drop_others() { store_.drop_others(); }  ///< drops the frames of other runs
  /// The method throws DataError unless frames 0 .. count-1 are there.
  void expect(std::int64_t count) const { store_.expect(count); }
  /// The method takes the state at once; the file is written while the run goes on. It throws what writing the frame
  /// before threw.
  void put(double time, std::int64_t number, Solver& solver);
  /// The method waits until every frame is on disk. It throws what writing the last one threw. HDF5 does one thing at a
  /// time: this is called before another file is written.
  void settle() { writing_.settle(); }
  /// The method hands a frame to the run file. It throws DataError when it is missing or another run's.
  void append_to(RunWriter& run, std::int64_t number) const { store_.append_to(run, number, scene_.map); }

 private:
  const Scene& scene_;
  const SolveOptions& options_;
  FrameStore store_;
  SideWork writing_;  ///< last: what it does needs the rest
};

}  // namespace talus::solver
