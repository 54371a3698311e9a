// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of speed and pressure (T25), made of what the points do: their momentum over the columns around them.
#pragma once

#include <cstddef>

#include "solver/integrator/point_sums.hpp"
#include "solver/material/material.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/parallel/tiles.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// The scatter of the points' mass [kg] and momentum [kg m/s] over the columns around them; at steps that record alone,
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
  /// The sums of a column.
  struct Sums {
    Real mass = 0;
    Vec3<Real> momentum{};
  };

  /// One thread: one point.
  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  TALUS_HD bool counts(int p) const { return !(clock && clock->motion_maps.is_due == 0) && points.cell[0][p] >= 0; }
  TALUS_HD static const Source& nodes_of(const Source& s) { return s; }
  TALUS_HD int column_of(const Source& s, int q) const { return grid.column(s.i + q % width, s.j + q / width); }
  TALUS_HD static int node_in(int column, int, int) { return column; }
  TALUS_HD static bool owns(int, int) { return true; }
  TALUS_HD void add(const Source& s, int q, Sums (&sums)[deep]) const {
    const Real share = static_cast<Real>(s.weights.x[q % width] * s.weights.y[q / width]) * s.mass;
    sums[0].mass += share;
    sums[0].momentum += s.velocity * share;
  }
  TALUS_HD void add_to_node(int n, const Sums& sums) const { scatter_add(&motion[n], sums.mass, sums.momentum); }
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

/// The recording of speed and pressure on a device: sum() what the points do, then record() it. Kernels that go through
/// the columns anyway may record in its place (record_motion() in map_view.hpp).
template <class Real, class Device, class Shape>
class MotionMaps {
 public:
  explicit MotionMaps(const Device& device) : motion_(device) {}

  /// The method sums up the points as they are, in a grid that was sorted for them: whenever the clock says so, or at
  /// once where that is null. Sums that stand are recorded before the next ones are made.
  template <class Grid>
  void sum(const ParticleView<Real>& points, const Materials<Real>& materials, Grid& grid, const Clock* clock) {
    const ProfilePhase<Device> phase(motion_.device(), "maps");
    const GridView<Real> view = grid.view();
    if (motion_.size() == 0) {
      motion_.resize(static_cast<std::size_t>(view.columns) * static_cast<std::size_t>(view.rows));
      motion_.fill_zero();
    }
    scatter_points(motion_.device(), points.count, grid.groups(),
                   ScatterMotion<Real, Shape>{view, points, materials, clock, motion_.data()});
  }

  /// The method records what was summed up.
  template <class Grid>
  void record(Grid& grid, const ColumnDensity<Real>& density, const MapView& maps) {
    const ProfilePhase<Device> phase(motion_.device(), "maps");
    for_each(motion_.device(), grid.active_blocks() * block_columns,
             RecordMotion<Real>{grid.view(), grid.active_list(), density, motion_.data(), maps});
  }

  /// The mass and the momentum over each column, [rows * columns] on the device; zero where nothing was summed up.
  Vec4<Real>* sums() { return motion_.data(); }
  /// The size of the sums [bytes].
  std::size_t bytes() const { return motion_.bytes(); }

 private:
  Buffer<Vec4<Real>, Device> motion_;  ///< mass and momentum over each column; zero between records
};

}  // namespace talus::solver
