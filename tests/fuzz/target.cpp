// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/target.hpp"

#include <unistd.h>

#include "common/stage/checksum.hpp"

namespace talus::fuzz {
namespace fs = std::filesystem;

std::map<std::string, Target>& targets() {
  static std::map<std::string, Target> all;
  return all;
}

InputFile::InputFile(Bytes bytes, const std::string& extension) {
  static const fs::path folder = fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
  path_ = folder / ("talus-fuzz-" + std::to_string(::getpid()) + extension);
  std::ofstream(path_, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
}

InputFile::~InputFile() {
  std::error_code ignored;
  fs::remove(path_, ignored);
}

void InputFile::seal() const { seal_file(path_, path_); }

void expect_result_or_error(const std::function<void()>& read) {
  try {
    read();
  } catch (const Error& error) {
    if (error.faults().empty() || error.faults().front().what.empty()) throw std::logic_error("an error without words");
  }
}

}  // namespace talus::fuzz
