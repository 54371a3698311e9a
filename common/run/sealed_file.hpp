// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 files between the stages: sealed (common/stage/checksum.hpp), with a mark and a format number.
#pragma once

#include <filesystem>

#include "common/run/hdf5.hpp"

namespace talus::h5 {

/// The attributes `format` and `format_version` of the root.
struct Format {
  const char* mark;          ///< "talus-run"
  const char* words;         ///< "a run of Talus"
  std::int64_t version = 1;  ///< to be raised when a reader would misread a file or miss something in it
};

void set_format(File& file, const Format& format);

/// Opens a file for reading once its seal has been checked. Throws DataError: missing, damaged, not sealed.
File open_sealed(const std::filesystem::path& path, const Naming& naming);

/// The same; refuses files of another mark or format number as well.
File open_sealed(const std::filesystem::path& path, const Naming& naming, const Format& format);

}  // namespace talus::h5
