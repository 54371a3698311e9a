// Particle to grid (P2G): mass, momentum and force of the points onto the nodes around them.
#pragma once

#include "solver/integrator/clock.hpp"
#include "solver/material/material.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus {

/// What P2G scatters.
enum class Scatter {
  impulse,         // momentum + dt * internal force, in one
  force,           // momentum and internal force apart (FLIP, damping, MUSL)
  momentum         // momentum alone (second mapping of MUSL)
};

/// One thread: one point. Adds to nodes[] (mass, momentum) and, for Scatter::force, forces[].
template <class Real, class Shape, Scatter what>
struct ParticleToGrid {
  GridView<Real> grid;
  ParticleView<Real> points;
  Material<Real> material;
  const Clock* clock;
  Vec4<Real>* nodes;
  Vec4<Real>* forces;
  const Vec3<double>* loads;  // force per volume of each load [N/m3]; null without loads
  bool affine;
  bool dilatant;

  TALUS_HD void operator()(int p) const {
    if (clock->halt != running || points.cell_x[p] < 0) return;
    const Stencil<Real, Shape> s(grid, points, p);
    const Real volume = points.volume[p];
    const Real mass = volume * material.density;
    // -V tau . grad N is linear in the weights' slopes: columns of -V tau, mapped to reference coordinates and per cell.
    Mat3<Real> pull{};
    if constexpr (what != Scatter::momentum) {
      const MaterialState<Real> state{points.elastic_of(p), points.log_volume[p],
                                      dilatant ? points.plastic_log_volume[p] : Real(0)};
      const Sym3<Real> tau = kirchhoff_stress(material, state);
      const Real dt = what == Scatter::impulse ? Real(clock->step_size) : Real(1);
      const Real across = -volume * dt / grid.spacing, up = -volume * dt / grid.layer_height;
      pull.a = Vec3<Real>{tau.xx, tau.xy, tau.xz} * across;
      pull.b = Vec3<Real>{tau.xy, tau.yy, tau.yz} * across;
      pull.c = (Vec3<Real>{tau.xz, tau.yz, tau.zz} - Vec3<Real>{tau.xx, tau.xy, tau.xz} * s.slope_x -
                Vec3<Real>{tau.xy, tau.yy, tau.yz} * s.slope_y) * up;
    }
    Vec3<Real> pulled{};  // by its load, in the units of `pull`
    if constexpr (what != Scatter::momentum) {
      if (loads && points.load[p] >= 0) {
        const Vec3<double> f = loads[points.load[p]];
        const Real dt = what == Scatter::impulse ? Real(clock->step_size) : Real(1);
        pulled = Vec3<Real>{Real(f.x), Real(f.y), Real(f.z)} * (volume * dt);
      }
    }
    Mat3<Real> turn{};
    Vec3<Real> corner = points.velocity_of(p);  // velocity at the first node
    if (affine) {
      turn = points.affine_of(p);
      corner += turn * Vec3<Real>{s.near_x, s.near_y, s.near_z};
    }
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        const BlockSlot& slot = grid.slot(s.i + a, s.j + b);
        const Real w = s.wx[a] * s.wy[b];
        const Vec3<Real> base = corner + turn.a * Real(a) + turn.b * Real(b);
        const Vec3<Real> sideways = pull.a * (s.gx[a] * s.wy[b]) + pull.b * (s.wx[a] * s.gy[b]);
        for (int c = 0; c < Shape::width; ++c) {
          const int layer = s.k + c > 0 ? s.k + c : 0;
          const int n = GridView<Real>::node(slot, s.i + a, s.j + b, layer);
          const Real share = w * s.wz[c] * mass;
          Vec3<Real> momentum = (base + turn.c * Real(c)) * share;
          const Vec3<Real> force = sideways * s.wz[c] + pull.c * (w * s.gz[c]) + pulled * (w * s.wz[c]);
          if constexpr (what == Scatter::impulse) momentum += force;
          scatter_add(&nodes[n], share, momentum);
          if constexpr (what == Scatter::force) scatter_add(&forces[n], Real(0), force);
        }
      }
    }
  }

};

}  // namespace talus
