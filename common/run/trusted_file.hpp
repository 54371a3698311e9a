// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// HDF5 files of this program, opened only where they are as they were written.
#pragma once

#include <filesystem>

#include "common/run/hdf5.hpp"

namespace talus::h5 {

/// An open file, and whether it had a seal (common/stage/checksum.hpp), which older versions did not leave.
struct TrustedFile {
  File file;
  bool sealed;
};

/// The file, opened for reading once its seal has been checked. One without a seal is read to its end by a process of
/// its own first (common/stage/child_reading.hpp). Throws DataError: missing, damaged, not HDF5.
TrustedFile open_trusted(const std::filesystem::path& path, const Naming& naming);

/// This function refuses a file of the present format whose seal is gone: it was cut short or changed.
void expect_seal(const TrustedFile& trusted);

}  // namespace talus::h5
