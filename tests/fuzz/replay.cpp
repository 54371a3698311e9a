// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Runs a fuzz target over files, as a test: talus-replay TARGET FOLDER|FILE... Whatever ended a fuzzer once lies there.
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iterator>

#include "tests/fuzz/target.hpp"

namespace fs = std::filesystem;

int main(int argc, char** argv) {
  const auto found = argc >= 3 ? talus::fuzz::targets().find(argv[1]) : talus::fuzz::targets().end();
  if (found == talus::fuzz::targets().end()) {
    std::fprintf(stderr, "usage: talus-replay TARGET FOLDER|FILE..., the target being one of:");
    for (const auto& [name, target] : talus::fuzz::targets()) std::fprintf(stderr, " %s", name.c_str());
    std::fprintf(stderr, "\n");
    return 2;
  }
  std::vector<fs::path> files;
  for (int a = 2; a < argc; ++a) {
    if (!fs::is_directory(argv[a]))
      files.emplace_back(argv[a]);
    else
      for (const auto& entry : fs::directory_iterator(argv[a])) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);  // the last line names the file on which it ends
    std::ifstream stream(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(stream), {}};
    found->second({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  }
  return files.empty() ? 1 : 0;
}
