// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels that measure the points: energies, and thickness on the map.
#pragma once

#include "common/run/motion.hpp"
#include "solver/material/material.hpp"
#include "solver/parallel/sums.hpp"
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
    return {
        {0.5 * mass * (vx * vx + vy * vy + vz * vz), -mass * (gravity.x * x + gravity.y * y + gravity.z * z),
         volume * static_cast<double>(elastic_energy(materials.of(points.material, points.plastic_shear, p), state)),
         volume, mass * vx, mass * vy, mass * vz, moves ? volume : 0, moves ? volume * speed : 0}};
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

}  // namespace talus::solver
