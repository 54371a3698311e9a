// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The files that a stage reads and writes.
#pragma once

#include <filesystem>
#include <vector>

namespace talus {

struct Dependencies {
  std::vector<std::filesystem::path> results;      ///< files that the stage writes; the last one written stands first
  std::vector<std::filesystem::path> inputs;       ///< files that it reads besides the recipe
  std::vector<std::filesystem::path> sealed = {};  ///< of these, sealed ones: it notes the checksum of what it reads
};

}  // namespace talus
