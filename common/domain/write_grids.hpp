// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grids into a file of OpenVDB, with every write checked.
#pragma once

#include <filesystem>
#include <ostream>

#include <openvdb/Metadata.h>
#include <openvdb/openvdb.h>

namespace talus {

/// The grids and the file's own metadata in the format of openvdb::io::File, into a stream that can be moved in. What
/// failed on the way shows in the state of the stream.
void write_grids(std::ostream& stream, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {});

/// The same into `partial`, which will be called `file`. openvdb::io::File does not look whether its writes succeed: a
/// file that lacks what one of them should have written would pass for whole. Throws DataError.
void write_grids(const std::filesystem::path& partial, const std::filesystem::path& file,
                 const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata = {});

}  // namespace talus
