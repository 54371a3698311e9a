// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/format.h>

#include <fstream>

#include "common/stage/machine.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

std::string processor_name() {
  std::ifstream stream("/proc/cpuinfo");
  for (std::string line; std::getline(stream, line);) {
    const auto colon = line.find(": ");
    if (line.starts_with("model name") && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "unknown processor";  // /proc/cpuinfo has no model name on some ARM systems
}

}  // namespace

std::string hardware() {
  const int threads = thread_limit();
  return fmt::format("{}, {} thread{}", processor_name(), threads, threads == 1 ? "" : "s");
}

std::string version() { return TALUS_VERSION " (" TALUS_COMMIT ")"; }

}  // namespace talus
