// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Faults of files: one that cannot be written (a full disk has a text of its own), and one that is refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "common/error.hpp"

namespace talus {

/// "PATH: cannot be written (REASON). mend". Libraries seldom say that the disk is full, so the file system is asked.
Fault write_fault(const std::filesystem::path& path, const std::string& reason);

/// This function throws the DataError "PATH: what (why). mend".
[[noreturn]] inline void refuse_file(const std::filesystem::path& path, const std::string& what, const std::string& why,
                                     const std::string& mend) {
  throw DataError({path.string() + ": " + what, why, mend});
}

/// Refuses a file of another format number than the one that this program reads.
[[noreturn]] inline void refuse_format(const std::filesystem::path& path, std::int64_t found, std::int64_t known,
                                       const std::string& mend) {
  refuse_file(path, "format " + std::to_string(found), "this version reads " + std::to_string(known), mend);
}

}  // namespace talus
