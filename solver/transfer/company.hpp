// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How alone a point is in plan, and how much of its stress it keeps then in column-implicit steps (T6d).
#pragma once

#include "solver/transfer/stencil.hpp"

namespace talus {

/// How the mass on the columns around a point lies to it.
template <class Real>
struct Company {
  Real all = 0, as_x = 0, as_y = 0;  ///< mass, and mass by the point's weights [kg]

  /// The method takes the mass of a column at the point's height [kg], and the column's weights.
  TALUS_HD void add(Real mass, Real wx, Real wy) {
    all += mass;
    as_x += mass * wx;
    as_y += mass * wy;
  }

  /// 0: mass is even around the point, in x or y at least; 1: it is spread as the point's own weights, for there is no
  /// other matter beside it. What touches a wall is never alone. Only splines can tell.
  template <class Shape>
  TALUS_HD Real alone(const Stencil<Real, Shape>& s) const {
    if (Shape::width != 3 || s.edge_x || s.edge_y || !(all > Real(0))) return Real(0);
    const Real x = share(as_x / all, s.wx), y = share(as_y / all, s.wy);
    return x < y ? x : y;
  }

 private:
  TALUS_HD static Real share(Real spread, const Real* w) {
    const Real even = Real(1.0 / 3), own = w[0] * w[0] + w[1] * w[1] + w[2] * w[2];
    return (spread - even) / (own - even);
  }
};

/// The share of its stress that a point keeps in a step in which waves cross `crossed` of a cell (T6d): below 1 from
/// 3/4 alone on, in steps beyond 0.5 CFL. A lone point has (omega dt)^2 <= 32 crossed^2, on slopes up to 45 degrees in
/// layers down to a sixteenth of a cell and up to 60 degrees in layers down to a quarter, and one that keeps a share s
/// of its stress is stable up to 2 + 2 / s.
template <class Real>
TALUS_HD Real share_kept_alone(Real alone, Real crossed) {
  const Real lonely = alone > Real(0.95) ? Real(1) : Real(5) * (alone - Real(0.75));
  const Real square = Real(32) * crossed * crossed * lonely;
  return square > Real(4) ? Real(2) / (square - Real(2)) : Real(1);
}

}  // namespace talus
