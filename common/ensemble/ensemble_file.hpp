// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of an ensemble have in common: HDF5, marked with what they are, sealed, written aside.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "common/run/hdf5.hpp"

namespace talus {

/// What a file holds.
struct EnsembleFileKind {
  const char* format;  ///< its mark: "talus counts"
  const char* words;   ///< "counts of an ensemble"
  const char* mend;    ///< what to do where it cannot be read
  /// Raised when a reader of today would misread the file or miss something in it; the version before is read as well
  /// (docs/reference/formats.md). 2 is the first of a release, so that none comes before it.
  std::int64_t version = 2;
  std::int64_t oldest = 2;  ///< that is read
};

/// Writes a file whose content `write` puts in. Throws DataError.
void write_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind,
                         const std::function<void(h5::File&)>& write);

/// Opens it, its seal, mark and version checked. Throws DataError.
h5::File open_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind);

}  // namespace talus
