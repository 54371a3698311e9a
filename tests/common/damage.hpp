// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Files as a bad disk, a broken copy or an enemy leave them.
#pragma once

#include <filesystem>
#include <functional>
#include <random>
#include <string>

#include "common/error.hpp"
#include "tests/common/scratch.hpp"

namespace talus::test {

/// The bytes of a sealed file without its seal, as a version before it would have left them.
inline std::string without_seal(const std::filesystem::path& file) {
  std::string bytes = text_of(file);
  bytes.resize(bytes.size() - 128);
  return bytes;
}

/// The bytes with one to eight of them changed, now and then cut short.
inline std::string damaged(std::string bytes, unsigned seed) {
  std::mt19937_64 random(seed);
  for (auto left = 1 + random() % 8; left > 0; --left)
    bytes[random() % bytes.size()] = static_cast<char>(random() % 256);
  if (random() % 8 == 0) bytes.resize(random() % bytes.size());
  return bytes;
}

/// Reads `count` damaged copies of a file without a seal; each must end in a DataError that names the file, or in a
/// reading. Returns how many were refused.
inline int refused_of(int count, const std::string& bytes,
                      const std::function<void(const std::filesystem::path&)>& read) {
  const Scratch scratch;
  int refused = 0;
  for (int n = 0; n < count; ++n) {
    const auto file = scratch.write("damaged", damaged(bytes, static_cast<unsigned>(n)));
    const std::string fault = fault_of<DataError>([&] { read(file); });
    if (fault.empty()) continue;
    ++refused;
    EXPECT_EQ(fault.find(file.string()), 0u) << "copy " << n << ": " << fault;
  }
  return refused;
}

}  // namespace talus::test
