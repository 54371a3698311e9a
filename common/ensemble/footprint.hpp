// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The cells that a member's flow or deposit covers, kept as runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace talus {

/// Lengths of runs of cells over the flat grid, the first outside, the second inside, and so on.
using Footprint = std::vector<std::int32_t>;

/// The footprint of what is thicker than `threshold` [m].
Footprint footprint_of(std::span<const double> thickness, double threshold);

/// 1 inside, 0 outside; `cells`: the number of cells of the grid.
std::vector<std::uint8_t> cells_of(const Footprint& footprint, std::size_t cells);

/// The number of cells inside.
std::size_t covered_cells(const Footprint& footprint);

}  // namespace talus
