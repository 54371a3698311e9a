// Foreign tools run by tests: what they print, and a loud skip where they are missing.
#pragma once

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>

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

/// Skip aloud where a foreign tool is missing; fail where it was promised (TALUS_REQUIRE_TOOLS).
#define TALUS_NEED_TOOL(check, package)                                                          \
  if (!talus::test::has_tool(check)) {                                                           \
    if (std::getenv("TALUS_REQUIRE_TOOLS") != nullptr) FAIL() << "missing: install " << package; \
    GTEST_SKIP() << "SKIPPED: not checked by a foreign tool; install " << package;               \
  }

}  // namespace talus::test
