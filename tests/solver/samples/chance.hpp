// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How densely points may lie that nothing moved but chance and their own weight (docs/notes/grid-and-transfer.md).
#pragma once

#include "solver/options/solve.hpp"

namespace talus::solver::testing {

/// The chance that a Poisson number of a mean is `least` or more.
inline double chance_of(double mean, int least) {
  double term = std::exp(-mean), below = 0;
  for (int n = 0; n < least; ++n) {
    below += term;
    term *= mean / (n + 1);
  }
  return std::fmax(1 - below, 0);
}

/// Points that lie by chance, as a flow that stirs them leaves them: their number in a cell is a Poisson number.
struct PointsByChance {
  double cells;    ///< what they fill
  double points;   ///< how many there are
  double records;  ///< how often a run is looked at

  /// The packing that cells with more than `of_volume` of the volume (0: a single cell) pass in one run of a hundred.
  double packing(double of_volume) const {
    const double share = cells / points;
    for (int held = 1;; ++held) {
      const int needed = static_cast<int>(of_volume * cells / (held * share)) + 1;
      if (records * chance_of(cells * chance_of(points / cells, held), needed) < 0.01) return held * share;
    }
  }
};

/// By how much the weight of a column compresses its lowest points: exp(pressure / modulus of confined compression).
inline double squash(double thickness, const MaterialOptions& m) {
  const double nu = m.poisson_ratio, confined = m.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu));
  return std::exp(m.density * 9.81 * thickness / confined);
}

}  // namespace talus::solver::testing
