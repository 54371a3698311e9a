// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Zones of the bed's friction: rows by elevation and ground, as rasters of the bed.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/bed.hpp"

namespace talus::preprocess {

/// This function lays the zones over the rasters of the bed, in the order of the
/// recipe, and says how much ground each has. A cell that polygons cover in part gets that part: of the coefficient,
/// and of the drag, which is proportional to 1 / xi. Throws DataError: polygons that are not valid, or a coefficient
/// added where none is known or below 0.
void lay_bed_zones(const std::vector<BedZone>& zones, const Raster& ground,
                   std::vector<std::pair<std::string, Raster>>& bed);

/// The raster of a number of the bed, made without values where there is none yet.
Raster& raster_named(std::vector<std::pair<std::string, Raster>>& bed, std::string_view name, const MapGrid& grid);

}  // namespace talus::preprocess
