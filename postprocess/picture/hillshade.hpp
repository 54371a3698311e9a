// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "common/map/raster.hpp"

namespace talus::postprocess {

/// Shade of every cell, 0 dark to 1 bright; NaN where the elevation is. Slope after Horn (1981) from the eight
/// neighbours; light from 225, 270, 315 and 360 deg at 45 deg height, weighted by sin^2(aspect - azimuth) so that no
/// ridge drowns in the light along it (Mark 1992). Stretched between the 2nd and 98th percentile.
std::vector<double> hillshade(const MapGrid& grid, const std::vector<double>& elevation);

/// Bilinear between cell centres at map coordinates (x, y), constant beyond the outermost; NaN neighbours count as
/// `missing`.
double sample(const MapGrid& grid, const std::vector<double>& values, double x, double y, double missing);

}  // namespace talus::postprocess
