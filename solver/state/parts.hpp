// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The smallest parts of all seeded points, numbered in the order of the points' ids: which of them a point holds.
#pragma once

#include "solver/state/particles.hpp"

namespace talus {

/// Parts first to first + count - 1.
struct Parts {
  std::size_t first, count;
};

/// The smallest parts that point p holds.
inline Parts parts_of(const ParticleState& points, std::size_t p) {
  const PartRange range(points.piece.empty() ? 1 : points.piece[p]);
  return {smallest_parts * static_cast<std::size_t>(points.id[p]) + static_cast<std::size_t>(range.first),
          static_cast<std::size_t>(range.count)};
}

}  // namespace talus
