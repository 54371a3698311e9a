// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the nodes add to the tangent of the points, and what holds them.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus::solver {

/// The constraints and additions on the diagonal of (T19): mass times inertia, other stiffness, and the directions a
/// node may move in. Arrays are over the stored nodes.
struct HeldNodes {
  int count = 0;
  const double* mass = nullptr;         ///< [kg]
  const Sym3<double>* freed = nullptr;  ///< projector on the free directions; zero: held, and no unknown
  double inertia = 0;                   ///< [1/s2]; 0 in statics
  double shift = 0;  ///< share by which the diagonal is raised: statics on few points has modes no point sees
  const Sym3<double>* stiffness = nullptr;  ///< of what else holds a node, such as friction [N/m]; null: nothing
};

/// The block of a node of K + mass inertia + stiffness, before what holds it; `tangent` is its block of K [N/m].
TALUS_HD Sym3<double> own_block(const HeldNodes& held, const Sym3<double>& tangent, int n) {
  const Sym3<double> b = tangent.plus_identity(held.mass[n] * held.inertia);
  return held.stiffness ? b + held.stiffness[n] : b;
}

/// The block of a node on the diagonal of (T19): P (K + mass inertia + stiffness) P + (I - P), which has the action on
/// the free directions and is regular.
TALUS_HD Sym3<double> held_block(const HeldNodes& held, const Sym3<double>& tangent, int n) {
  const Sym3<double> p = held.freed[n], b = own_block(held, tangent, n);
  const Vec3<double> e[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  Vec3<double> c[3];
  for (int a = 0; a < 3; ++a) c[a] = p * (b * (p * e[a])) + e[a] - p * e[a];
  return {c[0].x, c[1].y, c[2].z, c[1].x, c[2].y, c[2].x};
}

}  // namespace talus::solver
