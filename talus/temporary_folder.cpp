// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "talus/temporary_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "common/error.hpp"

namespace talus::command {

TemporaryFolder::TemporaryFolder(const std::string& name) {
  std::string pattern = (std::filesystem::temp_directory_path() / (name + "-XXXXXX")).string();
  if (::mkdtemp(pattern.data()) == nullptr)
    throw DataError(Fault{pattern + ": no folder can be made there", std::generic_category().message(errno),
                          "Set TMPDIR to a folder with room"});
  path_ = pattern;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace talus::command
