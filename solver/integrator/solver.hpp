// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The integrators behind one interface, for both devices and both precisions.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/run/map_fields.hpp"
#include "common/stage/stage.hpp"
#include "solver/integrator/scene.hpp"

namespace talus::solver {

/// The sums over the points: energies, volume, momentum, and what of them is in motion.
struct Energies {
  double kinetic = 0, potential = 0, elastic = 0;  ///< [J]; potential from the lowest ground
  double volume = 0;                               ///< initial volume of the points present [m3]
  Vec3<double> momentum;                           ///< [kg m/s]
  double moving_volume = 0;                        ///< of points faster than moving_faster_than [m3]
  double moving_flux = 0;                          ///< sum of their volume times speed [m4/s]
  /// The mean speed of what moves, by volume; 0 where nothing does [m/s].
  double moving_speed() const { return moving_volume > 0 ? moving_flux / moving_volume : 0; }
};

/// How densely points are packed: the volume of those in a cell about a node, over the room in it (T25b). 1: as at the
/// density at which they were released.
struct Packing {
  double p99 = 0;      ///< 99 % of the volume is packed no denser, to 0.01 [-]
  double largest = 0;  ///< of any cell [-]
};

/// The state that a checkpoint keeps.
struct SolverState {
  ParticleState points;
  const ParticleState* seeds = nullptr;  ///< of a scene that outlives this, in place of `points`; null otherwise
  std::vector<std::int64_t> homes = {};  ///< of points that have gone on since they were sorted: home_key(), or empty
  Clock clock;
  RunningMaps<std::vector<double>> maps;
  ContactState contacts;
  /// The points, whoever holds them.
  const ParticleState& all_points() const { return seeds != nullptr ? *seeds : points; }
};

/// The points of a state that has homes, each in its home cell and the octant of it that its key names: a sort leaves
/// them in their order, with the same keys. `columns`: of the grid.
ParticleState at_home(const SolverState& state, int columns);

struct StepStats {
  int newton = 0, linear = 0, cuts = 0;  ///< iterations; halvings of the step
  double residual = 0,
         linear_residual = 0;  ///< unbalanced force over the forces' size; residual of the last linear solve
  double over_cfl = 0;         ///< step over the CFL step
  bool indefinite = false;
};

struct BatchReport {
  Clock clock;
  bool sorted = false;        ///< the points have just been sorted
  bool can_be_saved = false;  ///< a run that goes on from state() as it is now ends with the same bits
  double outflow_volume = 0;  ///< left the domain in this batch [m3]
  int outflow_count = 0;
  StepStats stats;  ///< implicit: of the step
};

using MemoryShares = std::vector<std::pair<std::string, std::size_t>>;

/// An integrator with its state, of any precision and device. Methods wait for the device where they return state.
class Solver {
 public:
  virtual ~Solver() = default;
  /// The method steps until the next event, the next sort or a failure, at most a batch.
  virtual BatchReport advance() = 0;
  virtual void set_next_event(double time) = 0;  ///< sets the time not to step over [s]
  /// The method adds points; at the start or at an event, where those who left the domain have been dropped. `rate`:
  /// at which waves and speed cross the cells of those points [1/s], which bounds the next step (T11).
  virtual void add(const ParticleState& points, double rate) = 0;
  virtual Clock clock() const = 0;  ///< clock of the end of the last step
  /// All that a checkpoint keeps; what a run may go on from where BatchReport::can_be_saved.
  virtual SolverState state() const = 0;
  /// The same with what results are made of: places, boxes, volumes, ids and releases of the points, clock and maps.
  virtual SolverState end_state() const = 0;
  /// The points as frames show them: without affine velocity, acceleration, boxes and loads, whose lists are empty.
  ParticleState shown() const {
    ParticleState points;
    show(points);
    return points;
  }
  /// The same into lists that another call has filled, or empty ones.
  virtual void show(ParticleState& to) const = 0;
  virtual Energies energies() = 0;  ///< sums over the points
  virtual Packing packing() = 0;    ///< how densely the points are packed; at an event, or just after a sort
  /// The vertical thickness (T25), initial volume over cell area, [rows * columns] [m]; its sum times the cell area is
  /// the volume of the points to rounding.
  virtual std::vector<double> thickness() = 0;
  /// What water leaves the grains of the load on the bed, [rows * columns] [-]; empty where there is none.
  virtual std::vector<double> grains_share() const = 0;
  /// The impulse that every obstacle was given so far, along x, y and z [N s].
  virtual std::vector<Vec3<double>> obstacle_impulses() const = 0;
  virtual const TerrainTables& ground() const = 0;  ///< terrain as kernels use it
  virtual MemoryShares memory() const = 0;          ///< memory that is held where the steps are taken, by owner [bytes]
  /// The memory that is held where the steps are taken, of all owners together [bytes].
  std::size_t bytes() const {
    std::size_t total = 0;
    for (const auto& [owner, share] : memory()) total += share;
    return total;
  }
  virtual int particle_count() const = 0;  ///< number of points in the domain
};

/// This function throws the NumericalError that names the step, its unbalanced force and the way out.
[[noreturn]] void refuse_step(const Clock& clock, double step, const StepStats& stats, bool dynamic);

}  // namespace talus::solver
