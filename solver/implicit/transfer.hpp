// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Between points and nodes of an implicit step: what the points give to the nodes at its start, how far they go, their
// state at its end, and the maps of it.
#pragma once

#include <cstdint>

#include "solver/boundary/walls.hpp"
#include "solver/elements/forces.hpp"
#include "solver/implicit/node_fields.hpp"
#include "solver/state/map_view.hpp"

namespace talus::solver {

/// The scatter of mass (T3), momentum (T4), acceleration (as mass times it) and loads of the points to the nodes.
template <class Real, class Shape>
struct ScatterInertia : PointScatter<Real, Shape> {
  using Base = PointScatter<Real, Shape>;
  using Number = double;
  static constexpr int parts = 10;
  Materials<Real> materials;
  bool affine, accelerated;
  const Vec3<double>* loads;  ///< force per volume of each load at the end of the step [N/m3]; null without loads
  NodeArrays nodes;

  /// A point as its nodes see it: its weights and what it gives.
  struct Source : PointGradients<Real, Shape> {
    Real mass;
    Vec3<Real> corner;  ///< velocity at the first node
    Mat3<Real> turn{};  ///< its change per node
    Vec3<double> acceleration{}, load{};
    TALUS_HD Source(const ScatterInertia& k, int p) : PointGradients<Real, Shape>(k.grid, k.points, p) {
      const ParticleView<Real>& points = k.points;
      mass = points.volume[p] * k.materials.density(points.material, p);
      corner = points.velocity_of(p);
      if (k.affine) {
        turn = points.affine_of(p);
        corner += turn * Vec3<Real>{this->s.near_x, this->s.near_y, this->s.near_z};
      }
      if (k.accelerated)
        acceleration =
            widen(Vec3<Real>{points.acceleration[0][p], points.acceleration[1][p], points.acceleration[2][p]});
      if (k.loads && points.load[p] >= 0) load = k.loads[points.load[p]] * static_cast<double>(points.volume[p]);
    }
  };
  /// The sums that a node receives: mass [kg], momentum [kg m/s], mass times acceleration [N] and load [N].
  struct Sums {
    double mass = 0;
    Vec3<double> momentum, acceleration, load;
  };

  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }
  /// The nodes of column q receive their shares; see ScatterKernel for this and the next members.
  TALUS_HD void add(const Source& g, int q, Sums (&sums)[Base::deep]) const {
    const int a = Base::along_x(q), b = Base::along_y(q);
    TALUS_UNROLL
    for (int c = 0; c < Base::deep; ++c) {
      const double w = static_cast<double>(g.weight(a, b, c)), share = w * static_cast<double>(g.mass);
      sums[c].mass += share;
      sums[c].momentum += widen(g.corner + g.turn * Vec3<Real>{Real(a), Real(b), Real(c)}) * share;
      sums[c].acceleration += g.acceleration * share;
      sums[c].load += g.load * w;
    }
  }
  TALUS_HD void add_to_node(int at, const Sums& sums) const {
    talus::scatter_add(&nodes.mass[at], sums.mass);
    scatter_add(&nodes.velocity[at], sums.momentum);
    if (accelerated) scatter_add(&nodes.acceleration[at], sums.acceleration);
    if (loads) scatter_add(&nodes.external[at], sums.load);
  }
  TALUS_HD static void store(const Sums& sums, double* to) {
    to[0] = sums.mass;
    put(sums.momentum, to + 1);
    put(sums.acceleration, to + 4);
    put(sums.load, to + 7);
  }
  /// Whether there is a part q: accelerations and loads are not always there.
  TALUS_HD bool has(int q) const { return q < 4 || (q < 7 ? accelerated : loads != nullptr); }
  TALUS_HD double* part(int node, int q) const {
    return q == 0  ? &nodes.mass[node]
           : q < 4 ? &nodes.velocity[node].x + (q - 1)
           : q < 7 ? &nodes.acceleration[node].x + (q - 4)
                   : &nodes.external[node].x + (q - 7);
  }
};

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
    const Material<Real, Laws> material = materials.of(points, p);
    advance_material(material, gradient, Real(clock->step_size), state, means.at_point(p));
    if (points.plastic_shear) points.plastic_shear[p] += state.plastic_shear;
    points.set_elastic(p, state.elastic);
    points.log_volume[p] = state.log_volume;
    if (dilatant) points.plastic_log_volume[p] = state.plastic_log_volume;
    if constexpr (Shape::averaged) points.stretch_box(p, gradient, g.s.slope_x, g.s.slope_y);
    if (points.piece) points.stretch_sides(p, gradient);
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
  TALUS_HD void add_to_node(int at, const Sums& sums) const { scatter_add(&momentum[at], sums); }
  TALUS_HD static void store(const Sums& sums, double* to) { put(sums, to); }
  TALUS_HD double* part(int node, int q) const { return &momentum[node].x + q; }
};

/// One thread: one column of nodes. What the maps keep of it: thickness and arrival.
template <class Real>
struct RecordColumns {
  GridView<Real> grid;
  const int* active;
  const double* mass;
  ColumnDensity<Real> density;
  double time;
  MapView maps;
  TALUS_HD void operator()(int c) const {
    const ActiveColumn at(grid, active, c);
    if (!at.in_domain(grid)) return;
    const BlockSlot slot = grid.slots[at.block];
    double total = 0;
    for (int k = slot.first_layer; k < slot.first_layer + slot.layers; ++k)
      total += mass[GridView<Real>::node(slot, at.i, at.j, k)];
    const int column = grid.column(at.i, at.j);
    const double spacing = static_cast<double>(grid.spacing);
    if (total > 0) record_column(maps, column, {total, density.of(column, total), spacing}, time);
  }
};

}  // namespace talus::solver
