// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of an ensemble have in common: HDF5, marked with what they are, sealed, written aside.
#pragma once

#include <filesystem>
#include <functional>

#include "common/run/sealed_file.hpp"

namespace talus {

/// What a file holds.
struct EnsembleFileKind {
  h5::Format format;
  const char* mend;  ///< remedy where it cannot be read
};

/// Writes a file whose content `write` puts in. Throws DataError.
void write_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind,
                         const std::function<void(h5::File&)>& write);

/// Opens it, its seal, mark and format number checked. Throws DataError.
h5::File open_ensemble_file(const std::filesystem::path& path, const EnsembleFileKind& kind);

}  // namespace talus
