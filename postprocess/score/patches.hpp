// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Connected parts of a map.
#pragma once

#include <vector>

#include "common/map/raster.hpp"

namespace talus::postprocess {

/// `values` without the patches (cells above `threshold`, joined by eight neighbours) that hold no cell of `seeds`:
/// such cells become 0.
std::vector<double> patches_with(const MapGrid& grid, const std::vector<double>& values, double threshold,
                                 const std::vector<char>& seeds);

}  // namespace talus::postprocess
