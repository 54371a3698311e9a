// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A member's map of thickness, kept where there is any.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "common/ensemble/footprint.hpp"

namespace talus {

/// Thickness of the cells where there is any, in whole multiples of a quantum.
struct KeptThickness {
  Footprint cells;                   ///< that are thicker than 0; empty: nothing is kept
  std::vector<std::int32_t> values;  ///< of those cells, in their order [quanta]
  double quantum = 0;                ///< [m]

  /// Whether a map is kept, be it of nothing.
  bool kept() const { return !cells.empty(); }
  /// The map, 0 where there is nothing [m]; `count`: its number of cells.
  std::vector<double> thickness(std::size_t count) const;
};

/// Keeps a map of thickness in multiples of `quantum` [m]; NaN is nothing.
KeptThickness keep_thickness(std::span<const double> thickness, double quantum);

}  // namespace talus
