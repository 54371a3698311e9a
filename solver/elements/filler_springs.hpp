// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Statics on a body that does not fill its cells: nodes at its rim carry next to no material, and compression makes the
// tangent there indefinite (a rim cell turns about a point like a hinge). Weak springs hold such nodes to where the
// nodes further in would have them, in each of their elements (T17a; cf. the extension of Hoellig, Reif & Wipper 2001).
//
// Quadratic functions: node n is held to the straight line through its neighbours a and b inwards, k |u_n - 2 u_a +
// u_b|^2 / 2, which an affine motion, a turn too, does not feel. Linear ones have no third node: n is held to the
// fullest node of the element, a hundred times more weakly, for a turn does feel that. All act on the displacement of
// the step, so that no force builds up from step to step.
#pragma once

#include "solver/elements/element_list.hpp"
#include "solver/parallel/algorithms.hpp"

namespace talus::solver {

/// A spring (T17a) of an element between local nodes: k |u_node - (1 + lead) u_near + lead u_far|^2 / 2, lead 1 or 0.
struct FillerSpring {
  double k = 0;  ///< [N/m]; 0: none
  int node = 0, near = 0, far = 0;
  double lead = 0;
  /// The factor of node, near or far (`which` 0, 1, 2) in the spring's stretch.
  TALUS_HD double share(int which) const { return which == 0 ? 1 : which == 1 ? -(1 + lead) : lead; }
  /// The local number of node, near or far (`which` 0, 1, 2).
  TALUS_HD int local(int which) const { return which == 0 ? node : which == 1 ? near : far; }
};

/// The springs of a step as kernels read them; there are none without `mass`.
struct FillerSprings {
  const double* mass = nullptr;  ///< of the nodes [kg]
  double light = 0;              ///< nodes of less mass are held [kg]
  double stiffness = 0;          ///< of the spring on an empty node [N/m]

  TALUS_HD bool on() const { return mass != nullptr; }  ///< whether there are springs

  /// The spring (T17a) of local node n of an element with these nodes, width^3 of them, numbered as in ElementView.
  template <int width>
  TALUS_HD FillerSpring at(const int* nodes, int n) const {
    FillerSpring s;
    s.node = n;
    const double m = mass[nodes[n]];
    if (!(m > 0) || m >= light) return s;
    double best = m;
    if constexpr (width == 3) {
      const int c[3] = {n % 3, n / 3 % 3, n / 9}, stride[3] = {1, 3, 9};
      for (int pick = 1; pick < 8; ++pick) {
        int step = 0;
        bool inside = true;
        for (int d = 0; d < 3; ++d) {
          if ((pick >> d & 1) == 0) continue;
          inside = inside && c[d] != 1;
          step += c[d] == 0 ? stride[d] : -stride[d];
        }
        if (!inside) continue;
        const double ma = mass[nodes[n + step]], mb = mass[nodes[n + 2 * step]], fuller = ma < mb ? ma : mb;
        if (!(fuller > best)) continue;
        best = fuller;
        s.near = n + step;
        s.far = n + 2 * step;
        s.lead = 1;
      }
    } else {
      for (int a = 0; a < width * width * width; ++a) {
        if (!(mass[nodes[a]] > best)) continue;
        best = mass[nodes[a]];
        s.near = s.far = a;
      }
    }
    if (best > m) s.k = (width == 3 ? 1.0 : 1e-2) * stiffness * (1 - m / light);
    return s;
  }
};

/// This function adds to y the forces of the springs, K_springs x; x and y [nodes].
template <class Real, class Device, class Shape>
void apply_springs(const ElementList<Real, Device, Shape>& list, const FillerSprings& springs,
                   const NodeVector<Device>& x, NodeVector<Device>& y);
/// This function adds the diagonal blocks of K_springs to `blocks`, one of every stored node [N/m].
template <class Real, class Device, class Shape>
void add_spring_blocks(const ElementList<Real, Device, Shape>& list, const FillerSprings& springs,
                       Buffer<Sym3<double>, Device>& blocks);

}  // namespace talus::solver
