// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What GDAL may open: plain files of this machine, and nothing over a network unless that is asked for.
#pragma once

#include <filesystem>

namespace talus::gdal {

/// Takes from GDAL what reaches beyond this machine's files: file systems such as /vsicurl/, the drivers of services
/// and databases, HTTP requests, PROJ's downloads of grids, Python in a VRT, standard input. Called once, when GDAL
/// starts, unless --network was given (Python and standard input are taken always).
void close_the_network();

/// Throws DataError where a file, or one that it names (the sources of a VRT, at any depth), is a pipe, a socket or a
/// device, or where it names a place on a network or a database and --network was not given. Missing files pass:
/// whoever opens them says so.
void require_local(const std::filesystem::path& file);

}  // namespace talus::gdal
