// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/write_grids.hpp"

#include <openvdb/io/Archive.h>

#include <cerrno>
#include <fstream>
#include <system_error>

#include "common/error.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace {

/// Opens what openvdb::io::File keeps to itself: it opens and closes a stream of its own.
struct Archive : openvdb::io::Archive {
  using openvdb::io::Archive::write;
};

}  // namespace

void write_grids(std::ostream& stream, const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata) {
  Archive().write(stream, grids, /*seekable=*/true, metadata);
}

void write_grids(const std::filesystem::path& partial, const std::filesystem::path& file,
                 const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata) {
  errno = 0;
  std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
  if (stream) write_grids(stream, grids, metadata);
  stream.close();
  if (!stream) {
    const int reason = errno;
    throw DataError(
        write_fault(file, reason != 0 ? std::generic_category().message(reason) : "the system gave no reason"));
  }
}

}  // namespace talus
