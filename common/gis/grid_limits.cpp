// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/grid_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/error.hpp"
#include "common/stage/machine.hpp"

namespace talus {

void require_told_apart(const MapGrid& grid, const std::string& what) {
  constexpr double enough = 1e-3;  // of a cell
  const double farthest =
      std::max({std::abs(grid.west), std::abs(grid.east()), std::abs(grid.south), std::abs(grid.north())});
  const double apart = std::nextafter(farthest, std::numeric_limits<double>::infinity()) - farthest;
  if (apart <= enough * grid.cell) return;  // false where something is not finite
  throw DataError(
      {fmt::format("{}: west {:g}, south {:g}, cells of {:g} m", what, grid.west, grid.south, grid.cell),
       fmt::format("coordinates that large are {:.2g} m apart in double precision, so that its cells cannot "
                   "be told from one another",
                   apart),
       "Check its corner and its cell size; move it to where its CRS is valid"});
}

void require_room(double columns, double rows, double bytes_per_cell, const std::string& what,
                  const std::string& mend) {
  const std::string size = fmt::format("{}: {:.0f} x {:.0f} cells", what, columns, rows);
  constexpr double most = std::numeric_limits<int>::max();
  if (!(columns <= most) || !(rows <= most)) throw DataError({size, "columns and rows are counted in 32 bits", mend});
  require_memory(columns * rows * bytes_per_cell, size, mend);
}

}  // namespace talus
