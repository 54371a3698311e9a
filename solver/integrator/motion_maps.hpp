// The maps of speed and pressure (T25), made of what the points do: their momentum over the columns around them.
#pragma once

#include <cstddef>

#include "solver/integrator/point_sums.hpp"
#include "solver/material/material.hpp"
#include "solver/parallel/atomics.hpp"
#include "solver/parallel/buffer.hpp"
#include "solver/parallel/for_each.hpp"
#include "solver/parallel/profile.hpp"
#include "solver/state/clock.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// One thread: one point. Its mass [kg] and momentum [kg m/s] over the columns around it; at steps that record alone,
/// where there is a clock.
template <class Real, class Shape>
struct ScatterMotion {
  ParticleView<Real> points;
  Materials<Real> materials;
  int columns;
  const Clock* clock;  ///< null: always
  Vec4<Real>* motion;  ///< [rows * columns]

  TALUS_HD void operator()(int p) const {
    if (clock && clock->records_motion == 0) return;
    if (points.cell[0][p] < 0) return;
    const MapWeights<Real, Shape> w(points, p);
    const Real mass = points.volume[p] * materials.density(points.material, p);
    const Vec3<Real> velocity = points.velocity_of(p);
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        const Real share = static_cast<Real>(w.x[a] * w.y[b]) * mass;
        scatter_add(&motion[(w.j + b) * columns + w.i + a], share, velocity * share);
      }
    }
  }
};

/// One thread: one column. Its mean speed and pressure go into the maps; its sums are zero again afterwards.
template <class Real>
struct RecordMotion {
  GridView<Real> grid;
  const int* active;
  const Clock* clock;  ///< null: always
  ColumnDensity<Real> density;
  Vec4<Real>* motion;
  MapView maps;

  TALUS_HD void operator()(int c) const {
    if (clock && clock->records_motion == 0) return;
    const ActiveColumn at(grid, active, c);
    if (!at.in_domain(grid)) return;
    const int column = grid.column(at.i, at.j);
    const Vec4<Real> sum = motion[column];
    motion[column] = Vec4<Real>{};
    if (!(sum.w > Real(0))) return;
    const double mass = static_cast<double>(sum.w);
    const Vec3<double> momentum{static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z)};
    talus::record_motion(maps, column, {mass, density.of(column, mass), static_cast<double>(grid.spacing)},
                         length(momentum));
  }
};

/// The recording of speed and pressure on a device.
template <class Real, class Device, class Shape>
class MotionMaps {
 public:
  explicit MotionMaps(const Device& device) : motion_(device) {}

  /// The method records the points as they are, in a grid that was sorted for them: whenever the clock says so, or at
  /// once where that is null.
  template <class Grid>
  void record(const ParticleView<Real>& points, const Materials<Real>& materials, Grid& grid, const Clock* clock,
              const ColumnDensity<Real>& density, const MapView& maps) {
    const ProfilePhase<Device> phase(motion_.device(), "maps");
    const GridView<Real> view = grid.view();
    if (motion_.size() == 0) {
      motion_.resize(static_cast<std::size_t>(view.columns) * static_cast<std::size_t>(view.rows));
      motion_.fill_zero();
    }
    for_each_grouped(motion_.device(), points.count, grid.groups(),
                     ScatterMotion<Real, Shape>{points, materials, view.columns, clock, motion_.data()});
    for_each(motion_.device(), grid.active_blocks() * block_columns,
             RecordMotion<Real>{view, grid.active_list(), clock, density, motion_.data(), maps});
  }

  /// The size of the sums [bytes].
  std::size_t bytes() const { return motion_.bytes(); }

 private:
  Buffer<Vec4<Real>, Device> motion_;  ///< mass and momentum over each column; zero between records
};

}  // namespace talus::solver
