// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/domain/grids.hpp"

#include <cerrno>
#include <fstream>

#include <openvdb/io/Archive.h>

#include "common/stage/files.hpp"

namespace talus {
namespace {

/// Opens what openvdb::io::File keeps to itself: it opens and closes a stream of its own.
struct Archive : openvdb::io::Archive {
  using openvdb::io::Archive::write;
};

}  // namespace

void write_grids(const std::filesystem::path& partial, const std::filesystem::path& file,
                 const openvdb::GridPtrVec& grids, const openvdb::MetaMap& metadata) {
  errno = 0;
  std::ofstream stream(partial, std::ios::binary | std::ios::trunc);
  if (stream) Archive().write(stream, grids, /*seekable=*/true, metadata);
  stream.close();
  if (!stream) throw DataError(write_fault(file, reason_of(errno)));
}

}  // namespace talus
