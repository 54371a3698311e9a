// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Surveys of real ground beside the project (../shared/data, or the folder TALUS_DATA names), which may be missing.
#pragma once

#include <cstdlib>
#include <iostream>

#include "tests/places.hpp"
#include "tests/preprocess/terrain.hpp"

namespace talus::test {

inline std::filesystem::path survey_data(const std::string& file) {
  const char* given = std::getenv("TALUS_DATA");
  return (given ? std::filesystem::path(given) : std::filesystem::path(TALUS_SOURCE_DIR) / ".." / "shared" / "data") /
         file;
}

#define TALUS_NEED_DATA(file)                                                        \
  if (!std::filesystem::exists(file)) {                                              \
    std::cerr << "SKIPPED: " << (file).string() << " is missing (set TALUS_DATA)\n"; \
    GTEST_SKIP() << (file).string() << " is missing";                                \
  }

}  // namespace talus::test
