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

void expect_result_or_error(const Input& input, const std::function<void(const fs::path&)>& read) {
  static const fs::path folder = fs::is_directory("/dev/shm") ? fs::path("/dev/shm") : fs::temp_directory_path();
  const struct File {
    fs::path path;
    ~File() {
      std::error_code ignored;
      fs::remove(path, ignored);
    }
  } file{folder / ("talus-fuzz-" + std::to_string(::getpid()) + input.extension)};
  std::ofstream(file.path, std::ios::binary)
      .write(reinterpret_cast<const char*>(input.bytes.data()), static_cast<std::streamsize>(input.bytes.size()));
  if (input.sealed) seal_file(file.path, file.path);
  try {
    read(file.path);
  } catch (const Error& error) {
    if (error.faults().empty() || error.faults().front().what.empty()) throw std::logic_error("an error without words");
  }
}

}  // namespace talus::fuzz

#ifdef TALUS_FUZZING  // the name of the target that libFuzzer calls
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const talus::fuzz::Target target = talus::fuzz::targets().at(TALUS_FUZZING);
  target({data, size});
  return 0;
}
#endif
