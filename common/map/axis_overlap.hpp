// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How the cells of one regular axis cover those of another.
#pragma once

#include <vector>

namespace talus {

/// The cells of a grid along one of its axes.
struct CellAxis {
  double start = 0;  ///< outer edge of cell 0 [m]
  double cell = 0;   ///< width of a cell [m]
  int count = 0;     ///< of cells
};

/// A source cell and the length it shares with a target cell.
struct Overlap {
  int source = 0;     ///< index of the source cell
  double length = 0;  ///< [m]
};

/// For each target cell the source cells that overlap it, in rising order. [target.count]
std::vector<std::vector<Overlap>> axis_overlaps(const CellAxis& source, const CellAxis& target);

}  // namespace talus
