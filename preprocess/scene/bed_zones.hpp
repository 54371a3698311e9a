// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The bed's numbers as rasters: zones of friction, which are rows by elevation and ground, and polygons of a vector
// file whose attributes are called as the keys of [solve.base].
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/options/bed.hpp"

namespace talus::preprocess {

/// This function lays the zones over the rasters of the bed, in the order of the recipe, and says how much ground each
/// has. A cell that polygons cover in part gets that part: of the coefficient, and of the drag, which is proportional
/// to 1 / xi. Throws DataError: polygons that are not valid, or a coefficient added where none is known or below 0.
void lay_bed_zones(const std::vector<BedZone>& zones, const Raster& ground,
                   std::vector<std::pair<std::string, Raster>>& bed);

/// The number of the bed (common/domain/bed_numbers.hpp) that an attribute gives: the one of its name, or of the first
/// ten letters that a shapefile leaves of it; empty where there is none.
std::string_view bed_number_of(std::string_view attribute);

/// This function lays the numbers of a vector file's polygons over the rasters of the bed. A polygon gives the numbers
/// that its attributes are called after, and leaves the others. A cell that polygons cover in part has the mean by
/// area: of the coefficient where the number is an angle, of the drag (proportional to 1 / xi) where it is xi. Where
/// nothing is known beside the polygons, a cell belongs to them from half of its area on. Throws DataError, with
/// feature and field: no attribute names a number of the bed, a value is no number or cannot be, polygons overlap.
void lay_bed_polygons(const std::filesystem::path& file, const Raster& ground,
                      std::vector<std::pair<std::string, Raster>>& bed);

}  // namespace talus::preprocess
