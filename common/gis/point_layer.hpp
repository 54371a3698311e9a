// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Elevations at scattered points out of vector files, through OGR.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace talus {

/// Points with a height each, as a vector file gives them.
struct PointLayer {
  std::vector<double> x, y, z;  // in the units of their CRS; z as given
  std::string crs_wkt;          // empty = none named
  std::string z_name = {};      // of the attribute that z is; empty = the geometry's
};

/// What GDAL takes a file for when it is asked for a raster: its driver and count of cells; nullopt when it is none.
struct RasterGlance {
  std::string driver;
  std::size_t cells = 0;
};
/// Opens a file as a raster without reading cells.
std::optional<RasterGlance> glance_at_raster(const std::filesystem::path& file);

/// True when the first layer of a vector file holds points.
bool holds_points(const std::filesystem::path& file);

/// Which attributes hold z, by their names.
struct ZAttributes {
  std::function<bool(std::string_view)> known;                               // where the geometry has none
  std::function<bool(std::string_view)> first = [](auto) { return false; };  // whatever the geometry has
};

/// The points of a vector file's first layer. Throws DataError: not a vector file, a point without elevation.
PointLayer read_point_layer(const std::filesystem::path& file, const ZAttributes& attributes);

}  // namespace talus
