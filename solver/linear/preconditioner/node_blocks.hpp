// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// 3 x 3 blocks of nodes: products and inverses. A Mat3 holds columns.
#pragma once

#include "solver/parallel/math.hpp"

namespace talus::solver {

/// Whether a block is positive definite with a margin of 1e-12 against rounding.
TALUS_HD bool is_definite(const Sym3<double>& s) {
  constexpr double margin = 1e-12;
  const double minor = s.xx * s.yy - s.xy * s.xy;
  const double whole = s.zz * minor - s.xx * s.yz * s.yz - s.yy * s.xz * s.xz + 2 * s.xy * s.yz * s.xz;
  return s.xx > 0 && minor > margin * s.xx * s.yy && whole > margin * s.xx * s.yy * s.zz;
}

/// The absolute values of a block's diagonal, in place of a block that cannot be inverted.
TALUS_HD Sym3<double> diagonal_of(const Sym3<double>& s) {
  const auto safe = [](double d) { return fabs(d) > 0 ? fabs(d) : 1.0; };
  return {safe(s.xx), safe(s.yy), safe(s.zz), 0, 0, 0};
}

/// The product m s.
TALUS_HD Mat3<double> product(const Mat3<double>& m, const Sym3<double>& s) {
  return {m * Vec3<double>{s.xx, s.xy, s.xz}, m * Vec3<double>{s.xy, s.yy, s.yz}, m * Vec3<double>{s.xz, s.yz, s.zz}};
}
/// The product s m.
TALUS_HD Mat3<double> product(const Sym3<double>& s, const Mat3<double>& m) { return {s * m.a, s * m.b, s * m.c}; }
/// The transpose of m.
TALUS_HD Mat3<double> transposed(const Mat3<double>& m) {
  return {{m.a.x, m.b.x, m.c.x}, {m.a.y, m.b.y, m.c.y}, {m.a.z, m.b.z, m.c.z}};
}
/// The product m n^T.
TALUS_HD Mat3<double> product_transposed(const Mat3<double>& m, const Mat3<double>& n) {
  Mat3<double> out{};
  add_outer(out, m.a, n.a);
  add_outer(out, m.b, n.b);
  add_outer(out, m.c, n.c);
  return out;
}
/// The difference m - n.
TALUS_HD Mat3<double> difference(const Mat3<double>& m, const Mat3<double>& n) {
  return {m.a - n.a, m.b - n.b, m.c - n.c};
}
/// The difference s - m n^T, of which the caller knows that it is symmetric.
TALUS_HD Sym3<double> less(const Sym3<double>& s, const Mat3<double>& m, const Mat3<double>& n) {
  const Mat3<double> t = product_transposed(m, n);
  return {s.xx - t.a.x,
          s.yy - t.b.y,
          s.zz - t.c.z,
          s.xy - 0.5 * (t.a.y + t.b.x),
          s.yz - 0.5 * (t.b.z + t.c.y),
          s.xz - 0.5 * (t.a.z + t.c.x)};
}

}  // namespace talus::solver
