// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Foreign tools run by tests: what they print or make, and a loud skip where they are missing.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

#include "tests/common/scratch.hpp"

namespace talus::test {

/// What a command prints (both streams); its exit code in `code`.
inline std::string output_of(const std::string& command, int* code = nullptr) {
  std::string text;
  FILE* pipe = popen((command + " 2>&1").c_str(), "r");
  char buffer[4096];
  while (pipe != nullptr && fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  const int status = pipe != nullptr ? pclose(pipe) : -1;
  if (code != nullptr) *code = status;
  return text;
}

inline bool has_tool(const std::string& check) { return std::system((check + " > /dev/null 2>&1").c_str()) == 0; }

/// What GDAL's own validator says of a cloud-optimised GeoTIFF; needs TALUS_NEED_TOOL(TALUS_COG_VALIDATOR).
inline void expect_valid_cog(const std::filesystem::path& file) {
  int code = -1;
  const auto said =
      output_of("/usr/bin/python3 -m osgeo_utils.samples.validate_cloud_optimized_geotiff --full-check=yes '" +
                    file.string() + "'",
                &code);
  EXPECT_EQ(code, 0) << said;
  EXPECT_NE(said.find("is a valid cloud optimized GeoTIFF"), std::string::npos) << said;
}
#define TALUS_COG_VALIDATOR \
  "/usr/bin/python3 -c 'import osgeo_utils.samples.validate_cloud_optimized_geotiff'", "python3-gdal"

/// A folder in which foreign tools make files.
struct Workshop : testing::Test {
  Scratch scratch;
  std::string file(const std::string& name) const { return (scratch / name).string(); }
  /// Runs a command there that must work; what it says goes into log.txt.
  void shell(const std::string& command) const {
    const std::string quiet = "cd " + scratch.folder().string() + " && (" + command + ") > log.txt 2>&1";
    ASSERT_EQ(std::system(quiet.c_str()), 0) << command << "\n" << text_of(scratch / "log.txt");
  }
};

/// Skip aloud where a foreign tool is missing; fail where it was promised (TALUS_REQUIRE_TOOLS).
#define TALUS_NEED_TOOL(...) TALUS_NEED_TOOL_OF(__VA_ARGS__)
#define TALUS_NEED_TOOL_OF(check, package)                                                         \
  if (!talus::test::has_tool((check))) {                                                           \
    if (std::getenv("TALUS_REQUIRE_TOOLS") != nullptr) FAIL() << "missing: install " << (package); \
    GTEST_SKIP() << "SKIPPED: not checked by a foreign tool; install " << (package);               \
  }

}  // namespace talus::test
