// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What GDAL may open (plain files of this machine unless more is asked for), and which files it opens for a name.
#pragma once

#include <filesystem>
#include <vector>

namespace talus::gdal {

/// Takes from GDAL what reaches beyond this machine's files: file systems such as /vsicurl/, the drivers of services
/// and databases, HTTP requests, PROJ's downloads of grids, Python in a VRT, standard input. Called once, when GDAL
/// starts, unless --network was given (Python and standard input are taken always).
void close_the_network();

/// Throws DataError where a file, or one that it names (the sources of a VRT, at any depth), is a pipe, a socket or a
/// device, or where it names a place on a network or a database and --network was not given. Missing files pass.
void require_local(const std::filesystem::path& file);

/// The plain files that a file names (the sources of a VRT, at any depth) and itself; of names that only GDAL knows the
/// files behind them. Throws as require_local() does.
std::vector<std::filesystem::path> files_named_from(const std::filesystem::path& file);

}  // namespace talus::gdal

namespace talus {

/// The files, each followed by those that are read with it: projection, world file and statistics beside a raster, the
/// parts of a shapefile, the sources of a mosaic (VRT), the file behind a name such as NETCDF:file.nc:z. Sidecars are
/// listed where they are there; a file that is missing or cannot be read is listed alone. Empty paths are left out.
std::vector<std::filesystem::path> with_sidecars(const std::vector<std::filesystem::path>& files);

}  // namespace talus
