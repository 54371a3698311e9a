// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grids of OpenVDB into files, with every write checked.
#pragma once

#include <filesystem>

#include <openvdb/openvdb.h>

namespace talus {

/// Writes the grids and the file's own metadata in the format of openvdb::io::File into `partial`, which will be called
/// `file`. openvdb::io::File does not look whether its writes succeed: a file that lacks what one of them should have
/// written would pass for whole. Throws DataError.
void write_grids(const std::filesystem::path& partial, const std::filesystem::path& file,
                 const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {});

}  // namespace talus
