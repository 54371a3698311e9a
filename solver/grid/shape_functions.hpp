// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Weights of a material point on the nodes around it, one direction at a time. The offset is the distance from the
// nearest node in cells, -0.5 <= offset < 0.5; node `first(offset)` cells away from the nearest one carries weight[0].
// `half` is half the side of the box that the point stands for, in cells; only functions that are `averaged` over it
// look at it. `edge_share` is the integral of a node's function where the material ends at it, in cells.
#pragma once

#include "solver/parallel/macros.hpp"

namespace talus {

/// The functions by name: hats, quadratic B-splines, hats averaged over the box of each particle.
enum class ShapeKind { linear, quadratic, gimp };

/// The linear hat functions: two nodes.
struct Linear {
  static constexpr int width = 2;
  static constexpr double edge_share = 0.5;
  static constexpr bool averaged = false, spline = false;
  /// The first node with a weight, counted from the nearest one.
  template <class Real>
  TALUS_HD static int first(Real offset) {
    return offset < Real(0) ? -1 : 0;
  }
  /// This function writes the weights of a point nearer than `lowest` to a node as those at `lowest`, and returns the
  /// offset they stand for. A lone point would leave next to no mass on the node behind it, whose velocity then strains
  /// it out of all measure: sum N'^2 / N is 1 / s + 1 / (1 - s), 11 at the 0.1 of explicit steps.
  template <class Real>
  TALUS_HD static Real weigh_edge(Real offset, int, Real lowest, Real, Real weight[2], Real[2]) {
    const Real node = Real(first(offset)), s = offset - node, most = Real(1) - lowest;
    const Real kept = s < lowest ? lowest : s > most ? most : s;
    weight[0] = Real(1) - kept;
    weight[1] = kept;
    return node + kept;
  }
  /// This function writes weights and slopes, per cell, of the two nodes.
  template <class Real>
  TALUS_HD static void weigh(Real offset, Real, Real weight[2], Real slope[2]) {
    const Real s = offset - Real(first(offset));
    weight[0] = Real(1) - s;
    weight[1] = s;
    slope[0] = Real(-1);
    slope[1] = Real(1);
  }
};

/// The quadratic B-splines (Steffen, Kirby & Berzins 2008): three nodes, gradients continuous across cells.
struct Quadratic {
  static constexpr int width = 3;
  static constexpr double edge_share = 13.0 / 24;
  static constexpr bool averaged = false, spline = true;
  /// The first node with a weight, counted from the nearest one.
  template <class Real>
  TALUS_HD static int first(Real) {
    return -1;
  }
  /// This function writes the weights in the half cell beside an edge of the material (the ground, a wall) that lies on
  /// the nearest node, where the function of the node behind would reach through it. The field goes on there in a
  /// straight line (v_-1 = 2 v_0 - v_1), which leaves hats on the edge's node and the next: slopes stay continuous,
  /// linear fields exact, and the value on the edge is its node's. `inward` is +1 or -1; nearer than `lowest` the
  /// weights are those at `lowest`. The function returns the offset they stand for.
  template <class Real>
  TALUS_HD static Real weigh_edge(Real offset, int inward, Real lowest, Real, Real weight[3], Real slope[3]) {
    const Real away = offset * Real(inward);
    const Real s = away > lowest ? away : lowest;
    const bool ahead = inward > 0;  // no index to look up: weights stay in registers
    weight[0] = ahead ? Real(0) : s;
    weight[1] = Real(1) - s;
    weight[2] = ahead ? s : Real(0);
    slope[0] = ahead ? Real(0) : Real(-1);
    slope[1] = Real(-inward);
    slope[2] = ahead ? Real(1) : Real(0);
    return s * Real(inward);
  }
  /// This function writes weights and slopes, per cell, of the three nodes.
  template <class Real>
  TALUS_HD static void weigh(Real offset, Real, Real weight[3], Real slope[3]) {
    const Real below = Real(0.5) - offset, above = Real(0.5) + offset;
    weight[0] = Real(0.5) * below * below;
    weight[1] = Real(0.75) - offset * offset;
    weight[2] = Real(0.5) * above * above;
    slope[0] = -below;
    slope[1] = Real(-2) * offset;
    slope[2] = above;
  }
};

/// The hats averaged over the point's box (T2a; generalised interpolation, Bardenhagen & Kober 2004): three nodes, 0 <
/// half <= 0.5. Boxes that tile a body integrate the slopes of its nodes exactly, wherever the points are.
struct Gimp {
  static constexpr int width = 3;
  static constexpr double edge_share = 0.5;
  static constexpr bool averaged = true, spline = false;
  /// The first node with a weight, counted from the nearest one.
  template <class Real>
  TALUS_HD static int first(Real) {
    return -1;
  }
  /// This function writes the weights beside an edge, where the box ends: a point nearer to it is taken half a box
  /// inside. It returns the offset its weights stand for.
  template <class Real>
  TALUS_HD static Real weigh_edge(Real offset, int inward, Real, Real half, Real weight[3], Real slope[3]) {
    const Real away = offset * Real(inward);
    const Real inside = (away > half ? away : half) * Real(inward);
    weigh(inside, half, weight, slope);
    return inside;
  }
  /// This function writes weights (T2a) and slopes, per cell, of the three nodes.
  template <class Real>
  TALUS_HD static void weigh(Real offset, Real half, Real weight[3], Real slope[3]) {
    const Real low = offset - half, high = offset + half;
    const Real below = high < Real(0) ? high : Real(0),
               above = low > Real(0) ? low : Real(0);  // where the parts beside the node end
    slope[0] = low < below ? (low - below) / (high - low) : Real(0);
    slope[2] = high > above ? (high - above) / (high - low) : Real(0);
    slope[1] = -(slope[0] + slope[2]);
    weight[0] = slope[0] * Real(0.5) * (low + below);
    weight[2] = slope[2] * Real(0.5) * (high + above);
    weight[1] = Real(1) - weight[0] - weight[2];
  }
};

/// This function calls f with the shape functions of that name: f(Linear{}), f(Quadratic{}) or f(Gimp{}).
template <class F>
auto with_shape(ShapeKind kind, F&& f) {
  switch (kind) {
    case ShapeKind::linear: return f(Linear{});
    case ShapeKind::gimp: return f(Gimp{});
    case ShapeKind::quadratic: break;
  }
  return f(Quadratic{});
}

}  // namespace talus
