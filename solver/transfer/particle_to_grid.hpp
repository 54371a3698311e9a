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
  using Number = Real;
  static constexpr bool hot = true;  ///< see run_range()
  static constexpr int width = Shape::width, columns_each = width * width, deep = width,
                       parts = what == Scatter::springs ? 8
                               : what == Scatter::force ? 7
                                                        : 4;
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

  /// A point as its nodes see it: the part of its stencil that they need. It is as small as can be, for it decides how
  /// many a GPU holds at once.
  struct Source {
    static constexpr std::size_t wide = Shape::width;
    int i, j, k;
    Real wx[wide], wy[wide], wz[wide], gx[wide], gy[wide], gz[wide];
    Real mass;
    Vec3<Real> corner;    ///< velocity at the first node
    Mat3<Real> turn{};    ///< its change per node
    Mat3<Real> pull{};    ///< columns of -V tau, mapped to reference coordinates and per cell
    Vec3<Real> pulled{};  ///< by its load, in the units of `pull`
    Real stiffness = 0;   ///< of the springs between its layers, for a slope of one per cell [N/m]

    TALUS_HD Source(const ParticleToGrid& kernel, int p)
        : Source(kernel, p, Stencil<Real, Shape>(kernel.grid, kernel.points, p)) {}

   private:
    TALUS_HD Source(const ParticleToGrid& kernel, int p, const Stencil<Real, Shape>& s) : i(s.i), j(s.j), k(s.k) {
      TALUS_UNROLL
      for (int a = 0; a < width; ++a) {
        wx[a] = s.wx[a];
        wy[a] = s.wy[a];
        wz[a] = s.wz[a];
        gx[a] = s.gx[a];
        gy[a] = s.gy[a];
        gz[a] = s.gz[a];
      }
      const ParticleView<Real>& all = kernel.points;
      const Real volume = all.volume[p];
      mass = volume * kernel.materials.density(all.material, p);
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
      corner = all.velocity_of(p);
      if (kernel.affine) {
        turn = all.affine_of(p);
        corner += turn * Vec3<Real>{s.near_x, s.near_y, s.near_z};
      }
    }
  };

  /// The stiffness of point p across its layers (T6b) [N/m].
  TALUS_HD static Real stiffness_of(const ParticleToGrid& kernel, int p, const Stencil<Real, Shape>& s,
                                    const MaterialState<Real>& state) {
    const Real waves = wave_speed(kernel.materials.of(kernel.points.material, kernel.points.plastic_shear, p), state),
               layer = kernel.grid.layer_height, steep = Real(1) + s.slope_x * s.slope_x + s.slope_y * s.slope_y;
    return kernel.points.volume[p] * kernel.materials.density(kernel.points.material, p) * waves * waves * steep /
           (layer * layer);
  }

  /// The sums that a node receives: mass [kg], momentum [kg m/s] and force [N], or impulse [N s] as part of the
  /// momentum.
  struct Sums {
    Real mass = 0;
    Vec3<Real> momentum, force;
    Real spring = 0;  ///< to the node above [N/m]
  };

  /// One thread: one point. It scatters alone, as on a CPU.
  TALUS_HD void operator()(int p) const { scatter_point(*this, p); }

  // The members that ScatterKernel (tiles.hpp) asks for.
  /// The first node of a source; see ScatterKernel for this and the next members.
  TALUS_HD static const Source& nodes_of(const Source& s) { return s; }
  TALUS_HD int column_of(const Source& s, int q) const {
    return Stencil<Real, Shape>::column_at(grid, s.i + q % width, s.j + q / width);
  }
  TALUS_HD static int node_in(int column, int k, int c) { return Stencil<Real, Shape>::node(column, k, c); }
  TALUS_HD static bool owns(int k, int c) { return k + c >= 0; }  ///< false below the ground, where there is no node
  TALUS_HD static void store(const Sums& sums, Real* to) {
    to[0] = sums.mass;
    to[1] = sums.momentum.x;
    to[2] = sums.momentum.y;
    to[3] = sums.momentum.z;
    if constexpr (forces_apart(what)) {
      to[4] = sums.force.x;
      to[5] = sums.force.y;
      to[6] = sums.force.z;
    }
    if constexpr (what == Scatter::springs) to[7] = sums.spring;
  }
  TALUS_HD Real* part(int node, int q) const {
    return q < 4 ? &nodes[node].w + q : q < 7 ? &forces[node].x + (q - 4) : &forces[node].w;
  }
  /// Whether point p gives anything: it is in the domain, and the loop has not halted.
  TALUS_HD bool counts(int p) const { return clock->alarms.halt == running && points.cell[0][p] >= 0; }

  /// The nodes of column q receive mass (T3), momentum (T4) and force (T5).
  TALUS_HD void add(const Source& s, int q, Sums (&sums)[static_cast<std::size_t>(deep)]) const {
    const int a = q % width, b = q / width;
    const Real weight = s.wx[a] * s.wy[b], carried = weight * s.mass;
    Vec3<Real> velocity = s.corner, sideways{}, upwards{};
    if (affine) velocity += s.turn.a * Real(a) + s.turn.b * Real(b);
    if constexpr (what != Scatter::momentum) {
      // -V tau . grad N is linear in the weights' slopes.
      sideways = s.pull.a * (s.gx[a] * s.wy[b]) + s.pull.b * (s.wx[a] * s.gy[b]);
      upwards = s.pull.c * weight;
      if (loads) sideways += s.pulled * weight;
    }
    TALUS_UNROLL
    for (int c = 0; c < deep; ++c) {
      const Real share = carried * s.wz[c];
      sums[c].mass += share;
      sums[c].momentum += velocity * share;
      if (affine) velocity += s.turn.c;
      if constexpr (what == Scatter::impulse) sums[c].momentum += sideways * s.wz[c] + upwards * s.gz[c];
      if constexpr (forces_apart(what)) sums[c].force += sideways * s.wz[c] + upwards * s.gz[c];
      // Slopes grow from one layer to the next: the lowest and the highest bound those of two springs.
      if constexpr (what == Scatter::springs) {
        if (c + 1 < deep) sums[c].spring += s.stiffness * weight * (c == 0 ? -s.gz[0] : s.gz[deep - 1]);
      }
    }
  }

  TALUS_HD void add_to_node(int n, const Sums& sums) const {
    scatter_add(&nodes[n], sums.mass, sums.momentum);
    if constexpr (forces_apart(what)) scatter_add(&forces[n], sums.spring, sums.force);
  }
};

}  // namespace talus
