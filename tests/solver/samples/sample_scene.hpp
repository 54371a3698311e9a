// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes on the terrains of data_samples/terrains.hpp, made in memory, and what is measured of their runs.
#pragma once

#include <numeric>

#include "data_samples/terrains.hpp"
#include "solver/state/parts.hpp"
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

inline SampleScene scene_with(const samples::HardTerrain& terrain, double cell, double layer_height,
                              double bed_coefficient) {
  SampleScene scene{terrain, cell, layer_height};
  scene.options.material.friction_angle = 35;
  scene.options.material.youngs_modulus = 1e6;
  scene.options.base.friction_angle = std::atan(bed_coefficient) * 180 / M_PI;
  return scene;
}

/// The scenes of pipelines/rough-slope, bent-gully, cliff-bench and thinning-slide on coarse cells, softer (1 MPa):
/// what does not stand here has its default.
inline SampleScene rough_slope_scene() {
  SampleScene scene = scene_with(samples::rough_slope(), 6.4, 0.37, 0.2);
  scene.options.base.law = FrictionLaw::voellmy;
  scene.options.base.turbulence = 2000;
  return scene;
}
inline SampleScene bent_gully_scene() {
  SampleScene scene = scene_with(samples::bent_gully(), 4, 1.5, 0.15);
  scene.options.base.law = FrictionLaw::voellmy;
  scene.options.base.turbulence = 400;
  return scene;
}
inline SampleScene cliff_bench_scene() { return scene_with(samples::cliff_bench(), 5, 2, 0.4); }
inline SampleScene thinning_slide_scene() { return scene_with(samples::thinning_slide(), 10, 5, 0.28); }

inline void seed_column(Domain& d, int column, int row) {
  const double thickness = d.release_thickness.at(column, row), h = d.grid.cell;
  const int high = std::max(1, static_cast<int>(std::lround(2 * thickness / d.layer_height)));
  for (int n = 0; n < 4 * high; ++n) {
    d.points.x.push_back(d.grid.x(column) + h / 4 * (n % 2 == 0 ? -1 : 1));
    d.points.y.push_back(d.grid.y(row) + h / 4 * (n / 2 % 2 == 0 ? -1 : 1));
    const int layer = n / 4;
    d.points.height.push_back((layer + 0.5) * thickness / high);
    d.points.volume.push_back(thickness * h * h / (4 * high));
    d.points.extent_x.push_back(h / 2);
    d.points.extent_y.push_back(h / 2);
    d.points.release.push_back(0);
  }
}

/// The domain of a scene: its sample, and material points two by two in a cell, as talus-preprocess lays them: as many
/// in a column as make two of a layer.
inline Domain domain_of(const SampleScene& scene) {
  const samples::Sample sample = samples::LaidTerrain(scene.terrain, scene.cell, scene.pose).sample();
  Domain d;
  d.terrain = d.before = sample.rasters.at(0).second;
  d.release_thickness = sample.rasters.at(1).second;
  d.grid = d.terrain.grid;
  d.layer_height = scene.layer_height;
  d.release_names = {"release"};
  for (int row = 0; row < d.grid.rows; ++row)
    for (int column = 0; column < d.grid.columns; ++column)
      if (d.release_thickness.at(column, row) > 0) seed_column(d, column, row);
  return d;
}

/// A material point in numbers of its terrain: place on the terrain's own axes, elevation, height above the ground [m],
/// speed [m/s], upward velocity [m/s], volume [m3].
struct PointSeen {
  int id, part, parts;  ///< seed, first of its smallest parts (of all seeds), and how many of them it holds
  double x, y, z, height, speed, upward, volume;
};

/// A run of a scene.
class SampleRun {
 public:
  SampleRun(const SampleScene& scene, On on)
      : sample_(scene),
        laid_(scene.terrain, scene.cell, scene.pose),
        scene_(make_scene(domain_of(scene), scene.options)),
        solver_(make_solver(scene_, scene.options, on)),
        released_(std::accumulate(scene_.points.volume.begin(), scene_.points.volume.end(), 0.0)) {}
  /// The method goes on to a time [s].
  void run_to(double time) {
    testing::run_to(*solver_, time, [&](const BatchReport& batch) { left_ += batch.outflow_volume; });
  }
  /// The points as they are, in the order of their numbers.
  std::vector<PointSeen> points() const {
    const ParticleState s = solver_->state().points;
    const auto places = positions(scene_, s);
    const TerrainTables& ground = solver_->ground();
    std::vector<PointSeen> seen;
    for (std::size_t p = 0; p < s.size(); ++p) {
      const auto [x, y] = laid_.own(places[p][0] - samples::west, places[p][1] - samples::south);
      const double bed =
          ground.datum + terrain_at(scene_.grid, ground, s.cell[0][p] + s.offset[0][p], s.cell[1][p] + s.offset[1][p]);
      const double speed = std::hypot(s.velocity[0][p], s.velocity[1][p], s.velocity[2][p]);
      const Parts parts = parts_of(s, p);
      seen.push_back({s.id[p], static_cast<int>(parts.first), static_cast<int>(parts.count), x, y, places[p][2],
                      places[p][2] - bed, speed, s.velocity[2][p], s.volume[p]});
    }
    std::sort(seen.begin(), seen.end(), [](const PointSeen& a, const PointSeen& b) { return a.part < b.part; });
    return seen;
  }
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
inline Mean mean_of(const std::vector<PointSeen>& points) {
  Mean m;
  for (const PointSeen& p : points) {
    m.volume += p.volume;
    m.x += p.volume * p.x;
    m.y += p.volume * p.y;
    m.z += p.volume * p.z;
    m.half_square += p.volume * 0.5 * p.speed * p.speed;
  }
  for (double* sum : {&m.x, &m.y, &m.z, &m.half_square}) *sum /= m.volume;
  return m;
}

/// The x [m] below which a share of the volume lies.
inline double reach_of(const std::vector<PointSeen>& points, double share) {
  std::vector<std::pair<double, double>> along;
  double all = 0, sum = 0;
  for (const PointSeen& p : points) {
    along.emplace_back(p.x, p.volume);
    all += p.volume;
  }
  std::sort(along.begin(), along.end());
  for (const auto& [x, volume] : along) {
    sum += volume;
    if (sum >= share * all) return x;
  }
  return along.back().first;
}

/// The columns of a run as its points fill them.
struct Columns {
  std::vector<double> mass;
  std::vector<Vec3<double>> momentum;
};
inline Columns columns_of(const ParticleState& s, const GridShape& grid, double density) {
  Columns all{std::vector<double>(grid.terrain.size()), std::vector<Vec3<double>>(grid.terrain.size())};
  for (std::size_t p = 0; p < s.size(); ++p) {
    const std::size_t c = grid.index(s.cell[0][p], s.cell[1][p]);
    const double mass = density * s.volume[p];
    all.mass[c] += mass;
    all.momentum[c] += Vec3<double>{s.velocity[0][p], s.velocity[1][p], s.velocity[2][p]} * mass;
  }
  return all;
}

/// Half the mass that the median column has, by mass, of the masses of columns [kg]: what holds less is at the rim.
inline double rim_mass(std::vector<double> mass) {
  std::sort(mass.begin(), mass.end());
  const double half = 0.5 * std::accumulate(mass.begin(), mass.end(), 0.0);
  double below = 0;
  for (const double m : mass) {
    below += m;
    if (below >= half) return 0.5 * m;
  }
  return 0;
}

/// The momentum of the points one step after a state [kg m/s], and that step [s], `share` of the CFL step.
struct AfterStep {
  Vec3<double> momentum;
  double step;
};
inline AfterStep after_step(const SampleRun& run, const SolverState& state, double turbulence, double share, On on) {
  SolveOptions options = run.sample().options;
  options.base.turbulence = turbulence;
  const auto solver = resume_solver(run.scene(), options, on, state);
  const double step = 0.99 * share * state.clock.control.courant / positive_from_bits(state.clock.control.rate_bits);
  solver->set_next_event(state.clock.time + step);
  while (solver->advance().clock.alarms.halt != at_event) {
  }
  return {solver->energies().momentum, solver->clock().time - state.clock.time};
}

/// The drag of the bed [N] along the mean motion, at the state that a run is in, in a step of `share` of the CFL step.
struct Drag {
  double delivered;  ///< what one step takes of the points' momentum because of it
  double due;        ///< rho g U^2 / xi under every column that holds matter, under the rim in part
  double whole;      ///< the same with all of the bed under the rim's columns
};
inline Drag drag_of(const SampleRun& run, On on, double share = 1) {
  const SolverState state = run.solver().state();
  const SampleScene& sample = run.sample();
  const double xi = sample.options.base.turbulence, density = sample.options.material.density;
  // The same step with and without drag: nothing else of it differs.
  const AfterStep with = after_step(run, state, xi, share, on), without = after_step(run, state, 1e30, share, on);
  const Vec3<double> lost = (without.momentum - with.momentum) * (1 / with.step);
  const Vec3<double> way = without.momentum * (1 / length(without.momentum));
  const Columns columns = columns_of(state.points, run.scene().grid, density);
  const TerrainTables& ground = run.solver().ground();
  const double rim = rim_mass(columns.mass);
  Drag drag{dot(lost, way), 0, 0};
  for (std::size_t c = 0; c < columns.mass.size(); ++c) {
    if (!(columns.mass[c] > 0)) continue;
    const double sx = ground.slope_x[c], sy = ground.slope_y[c], steep = std::sqrt(1 + sx * sx + sy * sy);
    const Vec3<double> normal{-sx / steep, -sy / steep, 1 / steep}, mean = columns.momentum[c] * (1 / columns.mass[c]);
    const Vec3<double> along = mean - normal * dot(mean, normal);
    const double force = density * 9.81 / xi * length(along) * dot(along, way) * sample.cell * sample.cell * steep;
    drag.due += std::min(1.0, columns.mass[c] / rim) * force;
    drag.whole += force;
  }
  return drag;
}

/// The share of the cells that either map covers (by `threshold` or more) which both cover.
inline double common_cover(const std::vector<double>& a, const std::vector<double>& b, double threshold) {
  double both = 0, either = 0;
  for (std::size_t c = 0; c < a.size(); ++c) {
    both += a[c] >= threshold && b[c] >= threshold;
    either += a[c] >= threshold || b[c] >= threshold;
  }
  return both / either;
}

// How densely points may lie that nothing moved but chance and their own weight (docs/notes/grid-and-transfer.md).

/// The chance that a Poisson number of a mean is `least` or more.
inline double chance_of(double mean, int least) {
  double term = std::exp(-mean), below = 0;
  for (int n = 0; n < least; ++n) {
    below += term;
    term *= mean / (n + 1);
  }
  return std::fmax(1 - below, 0);
}

/// Points that lie by chance, as a flow that stirs them leaves them: their number in a cell is a Poisson number.
struct PointsByChance {
  double cells;    ///< what they fill
  double points;   ///< how many there are
  double records;  ///< how often a run is looked at

  /// The packing that cells with more than `of_volume` of the volume (0: a single cell) pass in one run of a hundred.
  double packing(double of_volume) const {
    const double share = cells / points;
    for (int held = 1;; ++held) {
      const int needed = static_cast<int>(of_volume * cells / (held * share)) + 1;
      if (records * chance_of(cells * chance_of(points / cells, held), needed) < 0.01) return held * share;
    }
  }
};

/// By how much the weight of a column compresses its lowest points: exp(pressure / modulus of confined compression).
inline double squash(double thickness, const MaterialOptions& m) {
  const double nu = m.poisson_ratio, confined = m.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  return std::exp(m.density * 9.81 * thickness / confined);
}

}  // namespace talus::solver::testing
