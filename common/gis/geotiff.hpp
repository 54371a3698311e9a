// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Rasters written as GeoTIFF, aside and renamed.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"

namespace talus {

/// What cells without a value hold in the GeoTIFFs that are written.
inline constexpr float nodata = -9999;

/// What a GeoTIFF says of itself beside its values.
struct RasterTags {
  std::string description;  ///< band description: "deposit thickness, vertical [m]"
  std::string unit;         ///< "m"
  std::vector<std::pair<std::string, std::string>> metadata;
};

/// Write a cloud-optimised GeoTIFF (COG driver, deflate, overviews, nodata -9999, Float64 so that volumes close to
/// 1e-9), aside and renamed. Throws DataError when anything fails on the way (disk full).
void write_cog(const std::filesystem::path& file, const Raster& raster, const RasterTags& tags);

/// Write a plain GeoTIFF (not COG) by the same conventions, for samples and intermediates. Throws DataError as
/// write_cog() does.
void write_geotiff(const std::filesystem::path& file, const Raster& raster, const RasterTags& tags);

}  // namespace talus
