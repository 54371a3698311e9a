// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whole rasters into memory, and what a raster file says of its CRS and of itself.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/map/raster.hpp"

namespace talus {

/// Band 1 of any GDAL raster, in metres, NaN for nodata: RasterFile(file).read(), see raster_file.hpp. A file without
/// CRS is taken as local metric coordinates; degrees, feet in the map's plane, and rasters without any value are
/// refused. Throws DataError.
Raster read_raster(const std::filesystem::path& file);

/// A raster whole: as it is where it is in metres, else reprojected to `crs_wkt`. Throws DataError as read_raster()
/// does.
Raster read_raster_in_metres(const std::filesystem::path& file, const std::string& crs_wkt);

/// True when a raster's CRS is projected and in metres, or when it names none. Throws DataError as RasterFile does.
bool in_metres(const std::filesystem::path& file);

/// WKT2 of the UTM zone (on WGS 84) that holds the centre of a raster. Throws DataError: no CRS, or beyond 84 degrees.
std::string utm_crs_of(const std::filesystem::path& file);

/// A number among the metadata items of a raster file (as RasterTags writes them); empty where the item is missing or
/// no number. Throws DataError when the file cannot be opened.
std::optional<double> raster_item(const std::filesystem::path& file, const std::string& name);

}  // namespace talus
