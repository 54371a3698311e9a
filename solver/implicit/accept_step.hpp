// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The way back to the points: how far they go in an implicit step, and their state at its end.
#pragma once

#include <cstdint>

#include "solver/boundary/walls.hpp"
#include "solver/elements/displacement_gradient.hpp"
#include "solver/elements/mean_dilation.hpp"
#include "solver/implicit/node_arrays.hpp"
#include "solver/material/tangent.hpp"
#include "solver/state/clock.hpp"
#include "solver/transfer/point_gradients.hpp"

namespace talus::solver {

/// One thread: one point. It measures how far the point goes for the displacement u, over how far it may: the largest
/// over all points, as float bits. In a dynamic step, and on sloping ground, it may go a cell. Statics over level
/// ground are exact however far it goes, short of going half a cell through an edge that it was too far from to meet.
template <class Real, class Shape>
struct MeasureMotion {
  GridView<Real> grid;
  ParticleView<Real> points;
  const Vec3<double>* u;
  bool dynamic;
  std::uint32_t* farthest;
  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    Vec3<double> way{};
    around(grid, g, [&](int n, int a, int b, int c) { way += u[n] * static_cast<double>(g.weight(a, b, c)); });
    const double across = static_cast<double>(g.across), up = static_cast<double>(g.up);
    const double rise = way.z - static_cast<double>(g.s.slope_x) * way.x - static_cast<double>(g.s.slope_y) * way.y;
    double cells = fmax(fmax(fabs(way.x), fabs(way.y)) * across, fabs(rise) * up);
    if (!dynamic && g.s.slope_x == Real(0) && g.s.slope_y == Real(0)) {
      const double x = points.cell[0][p] + static_cast<double>(points.offset[0][p]) + way.x * across;
      const double y = points.cell[1][p] + static_cast<double>(points.offset[1][p]) + way.y * across;
      const double z = points.cell[2][p] + static_cast<double>(points.offset[2][p]) + rise * up;
      const double through_x = fmax(grid.walls.west - x, x - grid.walls.east),
                   through_y = fmax(grid.walls.south - y, y - grid.walls.north);
      cells = 2 * fmax(fmax(through_x, through_y), fmax(-z, 0.0));
    }
    atomic_max_positive(farthest, cells < 1e30 ? static_cast<float>(cells) : 1e30f);
  }
};

/// The velocity and acceleration of the nodes at the end of a step; null in statics [m/s], [m/s2].
struct MotionAtEnd {
  const Vec3<double>* velocity = nullptr;
  const Vec3<double>* acceleration = nullptr;
};

/// The part of the new state that a pass over the points takes: MUSL takes the velocity first and the rest later.
struct AcceptedPart {
  bool speeds = true, deforms = true;
};

/// One thread: one point. It takes its state, velocity (T7) and position (T10) at the end of an accepted step.
template <class Real, class Shape, class Laws = MaterialLaws>
struct AcceptStep {
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real, Laws> materials;
  Clock* clock;
  NodeArrays nodes;  ///< velocity, acceleration: at the start
  MotionAtEnd end;
  const Vec3<double>* strain_displacement;  ///< what the strain comes from: u, or dt times the remapped velocity
  double kept;                              ///< share of the points' velocity finer than the grid that stays
  bool affine, dilatant;
  AcceptedPart part;
  MeanDilationView<Real> means;  ///< of strain_displacement

  TALUS_HD void operator()(int p) const {
    const PointGradients<Real, Shape> g(grid, points, p);
    const Vec3<double> move = gather_motion(p, g);
    if (!part.deforms) return;
    const Mat3<Real> gradient = displacement_gradient(grid, g, strain_displacement);
    MaterialState<Real> state = state_of(points, p, dilatant);
    const Material<Real, Laws> material = materials.of(points.material, points.plastic_shear, p);
    advance_material(material, gradient, Real(clock->step_size), state, means.at_point(p));
    if (points.plastic_shear) points.plastic_shear[p] += state.plastic_shear;
    points.set_elastic(p, state.elastic);
    points.log_volume[p] = state.log_volume;
    if (dilatant) points.plastic_log_volume[p] = state.plastic_log_volume;
    if constexpr (Shape::averaged) points.stretch_box(p, gradient, g.s.slope_x, g.s.slope_y);
    const double across = static_cast<double>(grid.spacing), up = static_cast<double>(grid.layer_height);
    points.move_by(p, Vec3<double>{move.x / across, move.y / across, move.z / up}, grid.walls);
    settle(p, g, wave_speed(material, state));
  }

 private:
  /// The method stores the new velocity (T7), acceleration and affine velocity (T8); it returns the way in reference
  /// coordinates, its rise by the nodes' own climb (T10) [m].
  TALUS_HD Vec3<double> gather_motion(int p, const PointGradients<Real, Shape>& g) const {
    const bool follows = grid.mapping == Mapping::terrain_following;
    Vec3<double> u{}, v{}, a1{};
    double climb = 0;
    Mat3<double> moment{}, slope{};
    around(grid, g, [&](int n, int a, int b, int c) {
      const double w = static_cast<double>(g.weight(a, b, c));
      u += nodes.u[n] * w;
      double nx = 0, ny = 0;
      if (follows) {
        const int column = grid.column(g.s.i + a, g.s.j + b);
        nx = static_cast<double>(grid.slope_x[column]);
        ny = static_cast<double>(grid.slope_y[column]);
      }
      climb += w * (nodes.u[n].z - nx * nodes.u[n].x - ny * nodes.u[n].y);
      if (!end.velocity || !part.speeds) return;
      v += (end.velocity[n] - nodes.velocity[n] * kept) * w;
      a1 += end.acceleration[n] * w;
      if (!affine) return;
      const Vec3<double> arm{static_cast<double>(g.s.near_x) + a, static_cast<double>(g.s.near_y) + b,
                             static_cast<double>(g.s.near_z) + c};
      add_outer(moment, end.velocity[n], arm * w);
      const Vec3<double> gradient{static_cast<double>(g.s.gx[a] * g.s.wy[b] * g.s.wz[c]),
                                  static_cast<double>(g.s.wx[a] * g.s.gy[b] * g.s.wz[c]),
                                  static_cast<double>(g.s.wx[a] * g.s.wy[b] * g.s.gz[c])};
      add_outer(slope, end.velocity[n], gradient);
    });
    if (end.velocity && part.speeds) {
      if (kept > 0) v += widen(points.velocity_of(p)) * kept;
      store(points.velocity, p, v);
      store(points.acceleration, p, a1);
      if (affine) points.set_affine(p, g.s.affine_velocity(moment, slope));
    }
    return {u.x, u.y, climb};
  }

  TALUS_HD static void store(Real* const target[3], int p, const Vec3<double>& v) {
    target[0][p] = static_cast<Real>(v.x);
    target[1][p] = static_cast<Real>(v.y);
    target[2][p] = static_cast<Real>(v.z);
  }

  TALUS_HD void settle(int p, const PointGradients<Real, Shape>& g, Real wave_speed) const {
    const Real speed = length(points.velocity_of(p));
    if (!(speed < Real(1e6)) || !(fabs(points.log_volume[p]) < Real(1e3))) {
      raise_flag(&clock->alarms.failed_point, points.id[p]);
      raise_flag(&clock->alarms.request, failed);
      return;
    }
    const int i = points.cell[0][p], j = points.cell[1][p];
    if (i < 0 || j < 0 || i >= grid.columns || j >= grid.rows || !grid.open[grid.column(i, j)]) {
      points.cell[0][p] = -1;
      atomic_add(&clock->outflow.volume, static_cast<double>(points.volume[p]));
      atomic_increment(&clock->outflow.count);
      return;
    }
    // Waves and speed over the cell, the bracket of (T11).
    const Real steep = Real(1) + g.s.slope_x * g.s.slope_x + g.s.slope_y * g.s.slope_y;
    const Real waves = Real(wave_speed * sqrt(Real(2) * g.across * g.across + steep * g.up * g.up));
    atomic_max_positive(&clock->control.rate_bits, static_cast<float>(waves + speed * (g.across + g.across + g.up)));
    atomic_max_positive(&clock->control.speed_bits, static_cast<float>(speed));
  }
};

/// The scatter of the momentum of the points' new velocity back to the nodes (MUSL; Sulsky, Zhou & Schreyer 1995).
template <class Real, class Shape>
struct ScatterVelocity : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int parts = 3;
  Materials<Real> materials;
  Vec3<double>* momentum;

  /// A point as its nodes see it: its weights and its momentum [kg m/s].
  struct Source : PointGradients<Real, Shape> {
    Vec3<double> momentum;
    TALUS_HD Source(const ScatterVelocity& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      momentum = widen(k.points.velocity_of(p)) *
                 static_cast<double>(k.points.volume[p] * k.materials.density(k.points.material, p));
    }
  };
  using Sums = Vec3<double>;

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  /// The nodes of column q receive their shares of the momentum; see ScatterKernel for this and the next members.
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c)
      sums[c] += g.momentum * static_cast<double>(g.weight(Base::along_x(q), Base::along_y(q), c));
  }
  /// The sums go to a stored node.
  TALUS_HD void add_to_node(int at, const Sums& sums) const { scatter_add(&momentum[at], sums); }
  /// The three numbers of a node's sums are put side by side.
  TALUS_HD static void store(const Sums& sums, double* to) { put(sums, to); }
  /// The location of component q of a stored node's momentum.
  TALUS_HD double* part(int node, int q) const { return &momentum[node].x + q; }
};

}  // namespace talus::solver
