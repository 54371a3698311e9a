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

/// Bytes for a file; sealed (common/stage/checksum.hpp), as anybody can who changes a file on purpose.
struct Input {
  Bytes bytes;
  const char* extension;
  bool sealed = false;
};

/// Calls `read` with a file that holds the input meanwhile, in memory where the machine has a file system there. The
/// ways it may end: it returns, or it throws one of the errors that programs report (common/error.hpp) with a text in
/// it. Anything else passes through and is a finding.
void expect_result_or_error(const Input& input, const std::function<void(const std::filesystem::path&)>& read);

}  // namespace talus::fuzz

/// Defines the target `name`, whose body follows.
#define TALUS_FUZZ_TARGET(name)                                               \
  static void fuzz_##name(talus::fuzz::Bytes bytes);                          \
  static const talus::fuzz::Registered fuzz_entry_##name(#name, fuzz_##name); \
  static void fuzz_##name(talus::fuzz::Bytes bytes)
