// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the points are summed up to: energies, thickness on the map, and the maps of speed and pressure (T25), made of
// their momentum over the columns around them.
#pragma once

#include <cstddef>

#include "common/run/mobility.hpp"
#include "solver/material/material.hpp"
#include "solver/parallel/sums.hpp"
#include "solver/state/map_view.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// The weights of a point on the columns around it, in double, so that they sum to one.
template <class Real, class Shape>
struct MapWeights {
  int i, j;  ///< first column
  double x[Shape::width], y[Shape::width];
  TALUS_HD MapWeights(const ParticleView<Real>& points, int p)
      : i(points.cell[0][p] + Shape::first(points.offset[0][p])),
        j(points.cell[1][p] + Shape::first(points.offset[1][p])) {
    double unused[Shape::width], half[2] = {};
    if constexpr (Shape::averaged) {
      for (int a = 0; a < 2; ++a) half[a] = static_cast<double>(points.half_extent(p, a, Real(1e-3)));
    }
    Shape::weigh(static_cast<double>(points.offset[0][p]), half[0], x, unused);
    Shape::weigh(static_cast<double>(points.offset[1][p]), half[1], y, unused);
  }
};

/// One thread: one point. Sums of its energies (kinetic, potential, elastic), volume, momentum and motion.
template <class Real, class Shape>
struct MeasureEnergies {
  static constexpr int rows = 9;
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real> materials;
  Vec3<double> gravity;
  bool dilatant;

  TALUS_HD Terms<rows> operator()(int p) const {
    const double volume = static_cast<double>(points.volume[p]);
    const double mass = volume * static_cast<double>(materials.density(points.material, p));
    const Vec3<Real> v = points.velocity_of(p);
    const double vx = static_cast<double>(v.x), vy = static_cast<double>(v.y), vz = static_cast<double>(v.z);
    const MaterialState<Real> state{points.elastic_of(p), points.log_volume[p],
                                    dilatant ? points.plastic_log_volume[p] : Real(0)};
    const double x = (points.cell[0][p] + static_cast<double>(points.offset[0][p])) * grid.spacing;
    const double y = (points.cell[1][p] + static_cast<double>(points.offset[1][p])) * grid.spacing;
    const double z = height(p);
    const double speed = sqrt(vx * vx + vy * vy + vz * vz);
    const bool moves = speed > moving_faster_than;
    return {{0.5 * mass * (vx * vx + vy * vy + vz * vz), -mass * (gravity.x * x + gravity.y * y + gravity.z * z),
             volume * static_cast<double>(elastic_energy(materials.of(points, p), state)), volume, mass * vx, mass * vy,
             mass * vz, moves ? volume : 0, moves ? volume * speed : 0}};
  }

 private:
  /// The height of point p above the lowest ground [m].
  TALUS_HD double height(int p) const {
    const double zeta = (points.cell[2][p] + static_cast<double>(points.offset[2][p])) * grid.layer_height;
    if (grid.mapping == Mapping::cartesian) return zeta;
    const MapWeights<Real, Shape> w(points, p);
    double ground = 0;
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a)
        ground += w.x[a] * w.y[b] * static_cast<double>(grid.terrain[grid.column(w.i + a, w.j + b)]);
    }
    return zeta + ground;
  }
};

/// One thread: one point. Its initial volume over the columns around it (T25) [m3].
template <class Real, class Shape>
struct ScatterThickness {
  ParticleView<Real> points;
  int columns;
  double* volume;

  TALUS_HD void operator()(int p) const {
    if (points.cell[0][p] < 0) return;
    const MapWeights<Real, Shape> w(points, p);
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        scatter_add(&volume[(w.j + b) * columns + w.i + a], w.x[a] * w.y[b] * static_cast<double>(points.volume[p]));
      }
    }
  }
};

/// The scatter of the points' mass [kg] and momentum [kg m/s] over the columns around them; in steps that record alone,
/// where there is a clock. See ScatterKernel (tiles.hpp) for its members: what a column is to other scatters is here a
/// column of one node.
template <class Real, class Shape>
struct ScatterMotion {
  using Number = Real;
  static constexpr int width = Shape::width, columns_each = width * width, deep = 1, parts = 4;
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real> materials;
  const Clock* clock;  ///< null: always
  Vec4<Real>* motion;  ///< [rows * columns]

  /// A point as the columns see it.
  struct Source {
    MapWeights<Real, Shape> weights;
    int i, j, k = 0;
    Real mass;
    Vec3<Real> velocity;
    TALUS_HD Source(const ScatterMotion& kernel, int p)
        : weights(kernel.points, p),
          i(weights.i),
          j(weights.j),
          mass(kernel.points.volume[p] * kernel.materials.density(kernel.points.material, p)),
          velocity(kernel.points.velocity_of(p)) {}
  };
  struct Sums {
    Real mass = 0;
    Vec3<Real> momentum{};
  };

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }  ///< one thread: one point
  TALUS_HD bool acts() const { return !clock || (clock->motion_maps.is_due != 0 && clock->alarms.halt == running); }
  TALUS_HD bool counts(int p) const { return acts() && points.cell[0][p] >= 0; }
  TALUS_HD static const Source& nodes_of(const Source& s) { return s; }
  TALUS_HD int column_of(const Source& s, int q) const { return grid.column(s.i + q % width, s.j + q / width); }
  TALUS_HD static int node_in(int column, int, int) { return column; }
  TALUS_HD static bool owns(int, int) { return true; }
  TALUS_HD void add(const Source& s, int q, Sums (&sums)[deep]) const {
    const Real share = static_cast<Real>(s.weights.x[q % width] * s.weights.y[q / width]) * s.mass;
    sums[0].mass += share;
    sums[0].momentum += s.velocity * share;
  }
  TALUS_HD void add_to_node(int n, const Sums& sums) const {
    scatter_add(&motion[n], Four<Real>(sums.mass, sums.momentum));
  }
  TALUS_HD static void store(const Sums& sums, Real* to) {
    to[0] = sums.mass;
    to[1] = sums.momentum.x;
    to[2] = sums.momentum.y;
    to[3] = sums.momentum.z;
  }
  TALUS_HD Real* part(int n, int q) const { return &motion[n].w + q; }
};

/// One thread: one column. Its mean speed and pressure go into the maps; its sums are zero again afterwards.
template <class Real>
struct RecordMotion {
  GridView<Real> grid;
  const int* active;
  ColumnDensity<Real> density;
  Vec4<Real>* motion;
  MapView maps;

  TALUS_HD void operator()(int c) const {
    const ActiveColumn at(grid, active, c);
    if (at.in_domain(grid)) record_motion_sums(maps, grid.column(at.i, at.j), motion, density, grid.spacing);
  }
};

/// The recording of speed and pressure on a device: run sum(), then record(). Kernels that go through the columns
/// anyway may record in its place (record_motion() in map_view.hpp).
template <class Real, class Device, class Shape>
class MotionMaps {
 public:
  explicit MotionMaps(const Device& device) : motion_(device) {}

  /// The scatter that sums up the points as they are, in a grid that was sorted for them: where the clock says so, or
  /// always where that is null. Sums that stand are recorded before the next ones are made.
  ScatterMotion<Real, Shape> sum(const ParticleView<Real>& points, const Materials<Real>& materials,
                                 const GridView<Real>& grid, const Clock* clock) {
    if (motion_.size() == 0)
      motion_.resize_zeroed(static_cast<std::size_t>(grid.columns) * static_cast<std::size_t>(grid.rows));
    return {grid, points, materials, clock, motion_.data()};
  }

  /// The method records what was summed up.
  template <class Grid>
  void record(Grid& grid, const ColumnDensity<Real>& density, const MapView& maps) {
    for_each(motion_.device(), grid.active_blocks() * block_columns,
             RecordMotion<Real>{grid.view(), grid.active_list(), density, motion_.data(), maps});
  }

  /// The mass and the momentum over each column, [rows * columns] on the device; zero where nothing was summed up.
  Vec4<Real>* sums() { return motion_.data(); }
  std::size_t bytes() const { return motion_.bytes(); }

 private:
  Buffer<Vec4<Real>, Device> motion_;  ///< mass and momentum over each column; zero between records
};

}  // namespace talus::solver
