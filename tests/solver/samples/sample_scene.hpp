// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes on the terrains of data_samples/hard_terrains.hpp, made in memory, and what is measured of their runs.
#pragma once

#include "data_samples/hard_terrains.hpp"
#include "tests/solver/scenes.hpp"

namespace talus::solver::testing {

/// A terrain as a scene: how it lies in its grid, and what its mass and its bed are.
struct SampleScene {
  samples::HardTerrain terrain;
  double cell;          ///< [m]
  double layer_height;  ///< [m]
  samples::Pose pose{};
  SolveOptions options{};
};

/// The scenes of pipelines/rough-slope, bent-gully, cliff-bench and thinning-slide on coarse cells, softer (1 MPa):
/// what does not stand here has its default.
SampleScene rough_slope_scene();
SampleScene bent_gully_scene();
SampleScene cliff_bench_scene();
SampleScene thinning_slide_scene();

/// The domain of a scene: its sample, and material points two by two in a cell, as talus-preprocess lays them: as many
/// in a column as make two of a layer.
Domain domain_of(const SampleScene& scene);

/// A material point in numbers of its terrain: place on the terrain's own axes, elevation, height above the ground [m],
/// speed [m/s], upward velocity [m/s], volume [m3].
struct PointSeen {
  int id;
  double x, y, z, height, speed, upward, volume;
};

/// A run of a scene.
class SampleRun {
 public:
  SampleRun(const SampleScene& scene, On on);
  /// The method goes on to a time [s].
  void run_to(double time);
  /// The points as they are, in the order of their numbers.
  std::vector<PointSeen> points() const;
  /// The vertical thickness [m] and its largest so far, [rows * columns].
  std::vector<double> thickness() const { return solver_->thickness(); }
  std::vector<double> peak_thickness() const { return solver_->state().maps.peak_thickness; }
  /// How densely the points are packed where run_to() has come to.
  Packing packing() const { return solver_->packing(); }
  const MapGrid& map() const { return scene_.map; }
  /// Volume that was released, and that has left the map [m3].
  double released() const { return released_; }
  double left() const { return left_; }
  const Solver& solver() const { return *solver_; }
  const Scene& scene() const { return scene_; }
  const SampleScene& sample() const { return sample_; }

 private:
  SampleScene sample_;
  samples::LaidTerrain laid_;
  Scene scene_;
  std::unique_ptr<Solver> solver_;
  double released_ = 0, left_ = 0;
};

/// Volume, centre, and speed of points.
struct Mean {
  double volume = 0, x = 0, y = 0, z = 0;
  double half_square = 0;  ///< kinetic energy per mass [m2/s2]
};
Mean mean_of(const std::vector<PointSeen>& points);

/// The x [m] below which a share of the volume lies.
double reach_of(const std::vector<PointSeen>& points, double share);

/// The drag of the bed [N] along the mean motion, at the state that a run is in, in a step of `share` of the CFL step.
struct Drag {
  double delivered;  ///< what one step takes of the points' momentum because of it
  double due;        ///< rho g U^2 / xi under every column that holds matter, under the rim in part
  double whole;      ///< the same with all of the bed under the rim's columns
};
Drag drag_of(const SampleRun& run, On on, double share = 1);

/// The share of the cells that either map covers (by `threshold` or more) which both cover.
double common_cover(const std::vector<double>& a, const std::vector<double>& b, double threshold);

}  // namespace talus::solver::testing
