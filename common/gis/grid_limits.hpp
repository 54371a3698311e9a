// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a grid may be like to be computed on: cells that numbers tell apart, and that memory holds.
#pragma once

#include <string>

#include "common/map/raster.hpp"

namespace talus {

/// Throws DataError naming `what` where coordinates are so large that numbers in double precision do not tell a
/// thousandth of a cell apart there, or where they are not finite.
void require_told_apart(const MapGrid& grid, const std::string& what);

/// Throws DataError naming `what` where columns or rows are more than can be counted in 32 bits, or where the cells do
/// not fit into memory with `bytes_per_cell`. Counts are real numbers, so that nothing has overflowed before. To be
/// called before anything is allocated.
void require_room(double columns, double rows, double bytes_per_cell, const std::string& what, const std::string& mend);

}  // namespace talus
