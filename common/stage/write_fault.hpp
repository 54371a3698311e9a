// The one text for "a file could not be written", with the disk-full case told apart.
#pragma once

#include <filesystem>
#include <string>

#include "common/error.hpp"

namespace talus {

/// "PATH: cannot be written (REASON). mend". Libraries seldom say that the disk is full, so the file system is asked.
Fault write_fault(const std::filesystem::path& path, const std::string& reason);

}  // namespace talus
