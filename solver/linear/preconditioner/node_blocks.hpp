// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// 3 x 3 blocks of nodes: whether they can be inverted, and what takes their place.
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

}  // namespace talus::solver
