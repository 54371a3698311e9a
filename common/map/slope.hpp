// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Slope of a surface, where thickness is turned between vertical and slope-normal.
#pragma once

#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// Cosine of the slope at every cell [rows * columns], by central differences (one-sided beside nodata and at the edge,
/// level where a cell has no neighbour); 1 where the surface is nodata.
std::vector<double> slope_cosine(const Raster& surface);

}  // namespace talus
