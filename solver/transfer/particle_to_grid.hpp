// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Particle to grid (P2G): mass, momentum and force of the points onto the nodes around them.
#pragma once

#include "solver/material/material.hpp"
#include "solver/state/clock.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus {

/// The quantities that P2G scatters.
enum class Scatter {
  impulse,  ///< momentum + dt * internal force, in one
  force,    ///< momentum and internal force apart (FLIP, damping, MUSL)
  springs,  ///< the same, and the springs between layers of column-implicit steps
  momentum  ///< momentum alone (second mapping of MUSL)
};

/// Whether forces are scattered apart from momentum.
inline constexpr bool forces_apart(Scatter what) { return what == Scatter::force || what == Scatter::springs; }

/// The scatter of the points to nodes[], mass (T3) and momentum (T4), and, where they are apart, to forces[] (T5),
/// whose w takes the spring to the node above (T6b).
template <class Real, class Shape, Scatter what, class Laws = MaterialLaws>
struct ParticleToGrid {
  static constexpr bool hot = true;  ///< see run_range()
  static constexpr int width = Shape::width, columns_each = width * width, deep = width, shares = 3;
  GridView<Real> grid;
  ParticleView<Real> points;
  Materials<Real, Laws> materials;
  const Clock* clock;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;
  const Vec3<double>* loads;  ///< force per volume of each load [N/m3]; null without loads
  bool affine;
  bool dilatant;

  /// The memory that the kernel moves for that many points [bytes].
  double bytes(int count) const {
    const int state = what == Scatter::momentum ? 0 : dilatant ? 8 : 7;
    return count * (points.place_bytes + (4 + (affine ? 9 : 0) + state) * static_cast<double>(sizeof(Real))) +
           grid.nodes * static_cast<double>((forces_apart(what) ? 4 : 2) * sizeof(*nodes));
  }

  /// A weight along one direction and its slope, per cell.
  struct alignas(2 * sizeof(Real)) Weight {
    Real value, slope;
  };
  /// One component of what a point gives, or all at once as Four<Real>, with the mass as first of them.
  template <class Number>
  struct alignas(2 * sizeof(Real)) Component {
    Number corner;   ///< of the momentum that the whole mass would have at the first node
    Number turn[3];  ///< its change per node
    Number pull[3];  ///< of -V tau, mapped to reference coordinates and per cell
    Number pulled;   ///< by the point's load, in the units of `pull`
  };
  /// A point as its nodes see it: the part of its stencil that they need. It is as small as can be, and a lane reads as
  /// little of it as can be, two numbers at a time: that decides how many points a GPU holds, and how long it takes.
  template <class Number>
  struct alignas(2 * sizeof(Real)) SourceOf {
    static constexpr std::size_t wide = Shape::width;
    Weight x[wide], y[wide], low, high;  ///< across the layers the first and the last; all sum to one, slopes to zero
    Component<Number> of[std::is_same_v<Number, Real> ? 3 : 1];
    Real layers[wide];   ///< mass by the weights across the layers [kg]
    Real stiffness = 0;  ///< of the springs between its layers, for a slope of one per cell [N/m]
    int i, j, k;

    TALUS_HD SourceOf(const ParticleToGrid& kernel, int p)
        : SourceOf(kernel, p, Stencil<Real, Shape>(kernel.grid, kernel.points, p)) {}

   private:
    TALUS_HD SourceOf(const ParticleToGrid& kernel, int p, const Stencil<Real, Shape>& s) : i(s.i), j(s.j), k(s.k) {
      TALUS_UNROLL
      for (int a = 0; a < width; ++a) {
        x[a] = {s.wx[a], s.gx[a]};
        y[a] = {s.wy[a], s.gy[a]};
      }
      low = {s.wz[0], s.gz[0]};
      high = {s.wz[width - 1], s.gz[width - 1]};
      const ParticleView<Real>& all = kernel.points;
      const Real volume = all.volume[p], mass = volume * kernel.materials.density(all.material, p);
      TALUS_UNROLL
      for (int c = 0; c < width; ++c) layers[c] = mass * s.wz[c];
      Mat3<Real> pull{}, turn{};
      Vec3<Real> pulled{};
      if constexpr (what != Scatter::momentum) {
        const MaterialState<Real> state{all.elastic_of(p), all.log_volume[p],
                                        kernel.dilatant ? all.plastic_log_volume[p] : Real(0)};
        const Sym3<Real> tau = kirchhoff_stress(kernel.materials.of(all.material, all.plastic_shear, p), state);
        const Real dt = what == Scatter::impulse ? Real(kernel.clock->step_size) : Real(1);
        const Real across = -volume * dt / kernel.grid.spacing, up = -volume * dt / kernel.grid.layer_height;
        if constexpr (what == Scatter::springs) stiffness = stiffness_of(kernel, p, s, state);
        pull.a = Vec3<Real>{tau.xx, tau.xy, tau.xz} * across;
        pull.b = Vec3<Real>{tau.xy, tau.yy, tau.yz} * across;
        pull.c = (Vec3<Real>{tau.xz, tau.yz, tau.zz} - Vec3<Real>{tau.xx, tau.xy, tau.xz} * s.slope_x -
                  Vec3<Real>{tau.xy, tau.yy, tau.yz} * s.slope_y) *
                 up;
        if (kernel.loads && all.load[p] >= 0) {
          const Vec3<double> f = kernel.loads[all.load[p]];
          pulled = Vec3<Real>{Real(f.x), Real(f.y), Real(f.z)} * (volume * dt);
        }
      }
      Vec3<Real> corner = all.velocity_of(p);
      if (kernel.affine) {
        turn = all.affine_of(p);
        corner += turn * Vec3<Real>{s.near_x, s.near_y, s.near_z};
      }
      corner = corner * mass;
      turn = {turn.a * mass, turn.b * mass, turn.c * mass};
      if constexpr (std::is_same_v<Number, Real>) {
        of[0] = {corner.x, {turn.a.x, turn.b.x, turn.c.x}, {pull.a.x, pull.b.x, pull.c.x}, pulled.x};
        of[1] = {corner.y, {turn.a.y, turn.b.y, turn.c.y}, {pull.a.y, pull.b.y, pull.c.y}, pulled.y};
        of[2] = {corner.z, {turn.a.z, turn.b.z, turn.c.z}, {pull.a.z, pull.b.z, pull.c.z}, pulled.z};
      } else {
        of[0] = {{mass, corner},
                 {{0, turn.a}, {0, turn.b}, {0, turn.c}},
                 {{0, pull.a}, {0, pull.b}, {0, pull.c}},
                 {0, pulled}};
      }
    }
  };
  using Source = SourceOf<Real>;

  /// The stiffness of point p across its layers (T6b) [N/m].
  TALUS_HD static Real stiffness_of(const ParticleToGrid& kernel, int p, const Stencil<Real, Shape>& s,
                                    const MaterialState<Real>& state) {
    const Real waves = wave_speed(kernel.materials.of(kernel.points.material, kernel.points.plastic_shear, p), state),
               layer = kernel.grid.layer_height, steep = Real(1) + s.slope_x * s.slope_x + s.slope_y * s.slope_y;
    return kernel.points.volume[p] * kernel.materials.density(kernel.points.material, p) * waves * waves * steep /
           (layer * layer);
  }

  /// A third of what the nodes of a column receive: a component of momentum [kg m/s] and force [N] of all of them, or
  /// of impulse [N s] as part of the momentum, and mass [kg] and the spring to the node above [N/m] of one of them. As
  /// Four<Real> all components, the mass with the momentum and the spring with the force.
  template <class Number>
  struct ShareOf {
    static constexpr auto each = static_cast<std::size_t>(deep);
    Real mass = 0, spring = 0;
    Number momentum[each]{}, force[each]{};
  };
  using Share = ShareOf<Real>;

  /// A CPU's thread: one point, all its components at once.
  TALUS_HD void operator()(int p) const {
    if (!counts(p)) return;
    const SourceOf<Four<Real>> source(*this, p);
    for (int q = 0; q < columns_each; ++q) {
      ShareOf<Four<Real>> whole;
      add(source, q, 0, whole);
      const int column = column_of(source, q);
      for (int c = 0; c < deep; ++c) {
        const int n = node_in(column, source.k, c);
        scatter_add(&nodes[n], whole.momentum[c]);
        if constexpr (forces_apart(what)) scatter_add(&forces[n], whole.force[c]);
      }
    }
  }

  // The members that SharedScatter (tiles.hpp) asks for.
  /// The first node of a source; see SharedScatter for this and the next members.
  TALUS_HD static const Source& nodes_of(const Source& s) { return s; }
  template <class Number>
  TALUS_HD int column_of(const SourceOf<Number>& s, int q) const {
    return Stencil<Real, Shape>::column_at(grid, s.i + q % width, s.j + q / width);
  }
  TALUS_HD static int node_in(int column, int k, int c) { return Stencil<Real, Shape>::node(column, k, c); }
  TALUS_HD static bool owns(int k, int c) { return k + c >= 0; }  ///< false below the ground, where there is no node
  /// Whether point p gives anything: it is in the domain, and the loop has not halted.
  TALUS_HD bool counts(int p) const { return clock->alarms.halt == running && points.cell[0][p] >= 0; }

  /// Share t of what the nodes of column q receive: mass (T3), momentum (T4) and force (T5).
  template <class Number>
  TALUS_HD static void add(const SourceOf<Number>& s, int q, int t, ShareOf<Number>& to) {
    const Weight x = s.x[q % width], y = s.y[q / width];
    const Component<Number>& own = s.of[t];
    const Real weight = x.value * y.value;
    const Number step = own.turn[2] * weight;
    // -V tau . grad N is linear in the weights' slopes.
    const Number sideways = own.pull[0] * (x.slope * y.value) + own.pull[1] * (x.value * y.slope) + own.pulled * weight,
                 upwards = own.pull[2] * weight;
    Number momentum = (own.corner + own.turn[0] * Real(q % width) + own.turn[1] * Real(q / width)) * weight;
    TALUS_UNROLL
    for (int c = 0; c < deep; ++c) {
      const Weight z = c == 0          ? s.low
                       : c + 1 == deep ? s.high
                                       : Weight{Real(1) - s.low.value - s.high.value, -s.low.slope - s.high.slope};
      to.momentum[c] += momentum * z.value;
      momentum += step;
      if constexpr (what != Scatter::momentum) {
        Number& force = forces_apart(what) ? to.force[c] : to.momentum[c];
        force += sideways * z.value;
        force += upwards * z.slope;
      }
    }
    // Slopes grow from one layer to the next: the lowest and the highest bound those of two springs.
    const auto spring = [&](int c) { return s.stiffness * weight * (c == 0 ? -s.low.slope : s.high.slope); };
    if constexpr (std::is_same_v<Number, Real>) {
      to.mass += weight * s.layers[t < deep ? t : 0];
      if constexpr (what == Scatter::springs) to.spring += spring(t);
    } else if constexpr (what == Scatter::springs) {
      for (int c = 0; c + 1 < deep; ++c) to.force[c] += Number(spring(c), {});
    }
  }

  /// The method calls give(number, sum) for share t of the vectors of node c of its column, stored as node n.
  template <class Give>
  TALUS_HD void give_vectors(const Share& s, int t, int c, int n, const Give& give) const {
    give((&nodes[n].x) + t, s.momentum[c]);
    if constexpr (forces_apart(what)) give((&forces[n].x) + t, s.force[c]);
  }
  /// The same for mass and spring, of node t.
  template <class Give>
  TALUS_HD void give_scalars(const Share& s, int t, int n, const Give& give) const {
    if (t >= deep) return;
    give(&nodes[n].w, s.mass);
    if constexpr (what == Scatter::springs) {
      if (t + 1 < deep) give(&forces[n].w, s.spring);
    }
  }
};

}  // namespace talus
