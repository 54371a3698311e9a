// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A folder that goes again with all it holds.
#pragma once

#include <filesystem>
#include <string>

namespace talus::command {

class TemporaryFolder {
 public:
  /// Makes a folder of a name that nobody has, in TMPDIR. Throws DataError.
  explicit TemporaryFolder(const std::string& name);
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  ~TemporaryFolder();
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace talus::command
