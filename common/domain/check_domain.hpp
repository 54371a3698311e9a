// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Is a domain possible? Every number of domain.vdb is looked at before the solver uses it.
#pragma once

#include <filesystem>

#include "common/domain/domain.hpp"

namespace talus {

/// The most cells that a map may have: an index of a cell is an int.
inline constexpr double most_map_cells = 2147483647.0;

/// This function throws DataError where the grid cannot be: no cells, more than most_map_cells, sizes or places that
/// are not finite.
void check_domain_grid(const std::filesystem::path& file, const MapGrid& grid, double layer_height);

/// This function throws DataError that names the first number that cannot be: elevations beyond 100 km, thickness below
/// zero, numbers of the bed that [solve.base] does not know or that are not finite, points outside the map, without
/// volume or of a release that is not there, places outside the map or without a name. The grid has been checked
/// before.
void check_domain(const std::filesystem::path& file, const Domain& domain);

}  // namespace talus
