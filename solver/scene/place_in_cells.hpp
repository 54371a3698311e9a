// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Positions as points have them.
#pragma once

#include <cmath>

namespace talus::solver {

/// This function finds the nearest node of a position in cells, and the offset from it.
inline void place_in_cells(double position, int& cell, double& offset) {
  const double nearest = std::floor(position + 0.5);
  cell = static_cast<int>(nearest);
  offset = position - nearest;
}

}  // namespace talus::solver
