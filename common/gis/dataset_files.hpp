// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which files GDAL opens when it is given one.
#pragma once

#include <filesystem>
#include <vector>

namespace talus {

/// The files, each followed by those that are read with it: projection, world file and statistics beside a raster, the
/// parts of a shapefile, the sources of a mosaic (VRT), the file behind a name such as NETCDF:file.nc:z. Sidecars are
/// listed where they are there; a file that is missing or cannot be read is listed alone. Empty paths are left out.
std::vector<std::filesystem::path> with_sidecars(const std::vector<std::filesystem::path>& files);

}  // namespace talus
