// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Contact points as kernels see them: the mass before a point, its friction, and the law of contact.
#pragma once

#include "solver/boundary/contact_points.hpp"
#include "solver/state/grid_view.hpp"
#include "solver/state/particles.hpp"
#include "solver/transfer/stencil.hpp"

namespace talus::solver {

/// The contact points as kernels see them.
template <class Real>
struct ContactView {
  ParticleView<Real> places;  ///< cells and offsets, nothing else
  const Vec3<Real>* normal;
  const Real* area;  ///< [m2]
  const int* body;
  const Real* body_friction;  ///< coefficient of each obstacle
  Real* inverse_mass;         ///< of the mass before it in this step [1/kg]; 0: there is none
  Vec3<double>* force;        ///< see ContactState
  Vec3<double>* impulse;

  /// The method calls f(node, share) for the nodes with any mass around point c, which the mass is before. Shares M_ic
  /// of (T12a) are weights times masses over their sum: they add up to one, and an impulse at the point changes the
  /// velocity of a node with next to no mass by no more than that of the others.
  template <class Shape, class Nodes, class F>
  TALUS_HD void around(const GridView<Real>& grid, const Nodes& nodes, int c, F&& f) const {
    const Stencil<Real, Shape> s(grid, places, c);
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        for (int d = 0; d < Shape::width; ++d) {
          const int n = grid.find(s.i + a, s.j + b, s.k + d > 0 ? s.k + d : 0);
          if (n < 0) continue;
          const Real share = s.wx[a] * s.wy[b] * s.wz[d] * nodes.mass(n) * inverse_mass[c];
          if (share > Real(0)) f(n, share);
        }
      }
    }
  }

  /// The mass before point c by weight [kg], 0 where that falls off along the normal. A surface stops what comes from
  /// the side it looks to, not what a wall thinner than a cell keeps on its other side, whose nodes are the same.
  template <class Shape, class Nodes>
  TALUS_HD Real mass_before(const GridView<Real>& grid, const Nodes& nodes, int c) const {
    const Stencil<Real, Shape> s(grid, places, c);
    const Vec3<Real> n = normal[c];
    const Real across = Real(1) / grid.spacing, up = (n.z - n.x * s.slope_x - n.y * s.slope_y) / grid.layer_height;
    Real mass = 0, rise = 0;
    for (int b = 0; b < Shape::width; ++b) {
      for (int a = 0; a < Shape::width; ++a) {
        const Real along = (n.x * s.gx[a] * s.wy[b] + n.y * s.wx[a] * s.gy[b]) * across, plain = s.wx[a] * s.wy[b];
        for (int d = 0; d < Shape::width; ++d) {
          const int node = grid.find(s.i + a, s.j + b, s.k + d > 0 ? s.k + d : 0);
          if (node < 0) continue;
          const Real m = nodes.mass(node);
          mass += plain * s.wz[d] * m;
          rise += (along * s.wz[d] + up * plain * s.gz[d]) * m;
        }
      }
    }
    return rise * grid.spacing > Real(-0.5) * mass ? mass : Real(0);
  }

  /// The ratio of friction to normal force at contact point c.
  TALUS_HD Real friction(int c) const { return body_friction[body[c]]; }

  /// The share to which the surface at point c is covered: a layer's worth of mass makes it a full one, of which half
  /// lies within the weights of a point on a surface.
  TALUS_HD Real filled(const GridView<Real>& grid, int c, double layer_mass) const {
    const Real share = Real(1) / (inverse_mass[c] * Real(0.5 * layer_mass) * grid.spacing * grid.spacing);
    return share < Real(1) ? share : Real(1);
  }

  /// The force or impulse that the surface can give towards the `required` one, H of (T12a): it pushes, and holds
  /// back slip up to `coefficient` times the push.
  TALUS_HD static Vec3<Real> hold(const Vec3<Real>& required, const Vec3<Real>& normal, Real coefficient) {
    const Real push = dot(required, normal);
    if (!(push > Real(0))) return {};
    const Vec3<Real> along = required - normal * push;
    const Real size = length(along), limit = coefficient * push;
    return size > limit ? normal * push + along * (limit / size) : required;
  }
};

}  // namespace talus::solver
