// A run from domain to run.h5: events in time, records, frames, checkpoints, the end.
#pragma once

#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>

#include "common/stage/stage.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/solve.hpp"
#include "solver/run/integrator_choice.hpp"
#include "solver/run/recorders/checkpoint.hpp"
#include "solver/run/recorders/frames.hpp"
#include "solver/run/side_work.hpp"
#include "solver/scene/make_scene.hpp"

namespace talus::solver {

struct RunPaths {
  std::filesystem::path run, checkpoint, frames, vdb_frames;
  explicit RunPaths(const std::filesystem::path& out)
      : run(out / "run.h5"), checkpoint(out / "checkpoint.h5"), frames(out / ".frames"), vdb_frames(out / "frames") {}
};

class Simulation {
 public:
  Simulation(const Domain& domain, const SolveOptions& options, On on, RunPaths paths, std::string fingerprint);

  /// Go on from checkpoint.h5 instead of the start.
  void resume(const std::filesystem::path& checkpoint);

  /// Step to the end. Throws NumericalError, DataError, Interrupted (checkpoint left).
  RunSummary run(const std::string& scene, const std::string& title);

 private:
  using WallClock = std::chrono::steady_clock;
  void start();
  void load_by_gravity();
  void build_solver(const SolverState& state);
  BatchReport advance();
  void count(const BatchReport& batch);
  void pass_events(double time);
  double next_event() const;
  void record(double time);
  void put_frame(double time);
  void save_checkpoint();
  bool checkpoint_due(double time) const;
  bool calm() const;
  void report(Progress& progress, const Clock& clock) const;
  [[noreturn]] void fail(const Clock& clock) const;
  void report_obstacles() const;
  void finish(RunSummary& summary);
  RunMaps final_maps() const;
  /// What belongs to which release, and what still lies in the ground.
  void tell_apart(RunMaps& maps) const;
  /// Whether a point is part of the slide: released, or taken along by more than a cell.
  bool went_along(const ParticleState& s, std::size_t p) const;
  double wall_time() const;
  PointFrame point_frame(double time, const ParticleState& points) const;

  const Domain& domain_;
  SolveOptions options_;
  On on_;
  RunPaths paths_;
  std::string fingerprint_;
  Scene scene_;
  std::optional<IntegratorChoice> choice_;  // integrator = "auto"
  BatchCost cost_;                          // since the last sort
  std::unique_ptr<Solver> solver_;
  FrameStore frames_;
  RunMemory memory_;
  double released_ = 0;  // [m3]
  double kinetic_ = 0;   // last recorded [J]
  double time_ = 0;      // [s]
  double over_cfl_ = 0;  // step over the CFL step
  WallClock::time_point started_;
  double wall_before_ = 0;
  SideWork writing_;  // last: what it does needs the rest
};

}  // namespace talus::solver
