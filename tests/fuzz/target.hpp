// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the fuzz targets share: each is a function of bytes, called by libFuzzer (make fuzz) or, over the files of
// tests/fuzz/corpus, by an ordinary test (replay.cpp).
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <span>

#include "common/error.hpp"

namespace talus::fuzz {

using Bytes = std::span<const std::uint8_t>;
using Target = void (*)(Bytes);

/// The targets of this program by name.
std::map<std::string, Target>& targets();

/// Puts a target into that list.
struct Registered {
  Registered(const char* name, Target target) { targets()[name] = target; }
};

/// A file that holds the bytes while it lives, in memory where the machine has a file system there.
class InputFile {
 public:
  InputFile(Bytes bytes, const std::string& extension);
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;
  ~InputFile();
  const std::filesystem::path& path() const { return path_; }
  /// Adds a seal (common/stage/checksum.hpp), as anybody can who changes a file on purpose.
  void seal() const;

 private:
  std::filesystem::path path_;
};

/// Calls `read`. The ways it may end: it returns, or it throws one of the errors that programs report
/// (common/error.hpp) with a text in it. Anything else passes through and is a finding.
void expect_result_or_error(const std::function<void()>& read);

}  // namespace talus::fuzz

/// Defines the target `name`, whose body follows; with TALUS_FUZZING it is what libFuzzer calls.
#ifdef TALUS_FUZZING
#define TALUS_FUZZ_TARGET(name)                                                       \
  static void fuzz_##name(talus::fuzz::Bytes bytes);                                  \
  extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) { \
    fuzz_##name({data, size});                                                        \
    return 0;                                                                         \
  }                                                                                   \
  static void fuzz_##name(talus::fuzz::Bytes bytes)
#else
#define TALUS_FUZZ_TARGET(name)                                               \
  static void fuzz_##name(talus::fuzz::Bytes bytes);                          \
  static const talus::fuzz::Registered fuzz_entry_##name(#name, fuzz_##name); \
  static void fuzz_##name(talus::fuzz::Bytes bytes)
#endif
