// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cerrno>
#include <charconv>
#include <fstream>
#include <optional>
#include <system_error>
#include <vector>

#include <fmt/format.h>

#include "common/stage/checksum.hpp"
#include "common/stage/context.hpp"
#include "common/stage/input_file.hpp"
#include "common/stage/stage.hpp"
#include "common/stage/write_fault.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t seal_size = 128;
constexpr std::string_view mark = "\n# talus-seal 1, SHA-256 ";  // its first byte ends what would be text before it

struct SealLine {
  std::string digest;
  std::uint64_t length = 0;  ///< of what it seals [bytes]
};

std::string text_of(const SealLine& seal) {
  std::string text = fmt::format("{}{}, bytes {:020}", mark, seal.digest, seal.length);
  text.resize(seal_size - 1, ' ');
  return text + '\n';
}

/// The seal that stands in the last bytes of a file, none where they say something else.
std::optional<SealLine> seal_in(const std::string& end) {
  constexpr std::size_t hex = 64, digits = 20;
  if (end.size() != seal_size || !end.starts_with(mark)) return {};
  SealLine seal{end.substr(mark.size(), hex)};
  const char* first = end.data() + mark.size() + hex + std::string_view(", bytes ").size();
  if (std::from_chars(first, first + digits, seal.length).ec != std::errc()) return {};
  return text_of(seal) == end ? std::optional(seal) : std::nullopt;
}

/// The sum of the first bytes of a file; none where they cannot be read.
std::optional<Sha256> sum_of(std::istream& stream, std::uint64_t length) {
  Sha256 sum;
  std::vector<std::uint8_t> part(std::min<std::uint64_t>(length, Sha256::read_at_once));
  while (length > 0) {
    const auto bytes = static_cast<std::size_t>(std::min<std::uint64_t>(length, part.size()));
    if (!stream.read(reinterpret_cast<char*>(part.data()), static_cast<std::streamsize>(bytes))) return {};
    sum.add(std::span(part).first(bytes));
    length -= bytes;
  }
  return sum;
}

std::string system_reason() {
  return errno != 0 ? std::generic_category().message(errno) : "the system gave no reason";
}

/// Whether an open file is sealed; see check_seal(). Notes the checksum of the whole file where it is.
bool is_sealed(const fs::path& file, std::ifstream& stream, const std::string& mend) {
  std::error_code error;
  const std::uint64_t size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  if (error || size < seal_size) return false;
  errno = 0;
  std::string end(seal_size, '\0');
  stream.seekg(static_cast<std::streamoff>(size - seal_size));
  if (!stream.read(end.data(), seal_size)) refuse_file(file, "cannot be read", system_reason(), mend);
  const auto seal = seal_in(end);
  if (!seal) return false;
  if (seal->length != size - seal_size) {
    refuse_file(file, "is damaged",
                fmt::format("it holds {} bytes, its last line speaks of {}", size - seal_size, seal->length), mend);
  }
  stream.seekg(0);
  auto sum = sum_of(stream, seal->length);
  if (!sum) refuse_file(file, "cannot be read", system_reason(), mend);
  Sha256 whole = *sum;
  whole.add({reinterpret_cast<const std::uint8_t*>(end.data()), end.size()});
  if (const std::string digest = sum->digest(); digest != seal->digest) {
    refuse_file(file, "is damaged",
                fmt::format("bytes have changed since it was written: its SHA-256 is {}..., its last line says {}...",
                            digest.substr(0, 12), seal->digest.substr(0, 12)),
                mend);
  }
  context().note_checksum(file, whole.digest());
  stream.seekg(0);
  return true;
}

}  // namespace

void seal_file(const fs::path& file, const fs::path& shown) {
  errno = 0;
  std::error_code error;
  SealLine seal{"", fs::file_size(file, error)};
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  auto sum = error ? std::nullopt : sum_of(stream, seal.length);
  if (!sum) throw DataError(write_fault(shown, error ? error.message() : system_reason()));
  seal.digest = sum->digest();
  stream.clear();
  stream.seekp(0, std::ios::end);
  stream << text_of(seal);
  stream.close();
  if (!stream) throw DataError(write_fault(shown, system_reason()));
}

bool check_seal(const fs::path& file, const std::string& mend) {
  if (!fs::is_regular_file(file)) return false;
  std::ifstream stream(file, std::ios::binary);
  return is_sealed(file, stream, mend);
}

std::ifstream open_sealed_stream(const fs::path& file, const std::string& mend) {
  if (!fs::exists(file)) refuse_file(file, "no such file", "", mend);
  require_plain(file);
  if (fs::is_directory(file)) refuse_file(file, "cannot be read", "it is a folder", "Check the path");
  errno = 0;
  std::ifstream stream(file, std::ios::binary);
  if (!stream && errno == ENOMEM) throw std::bad_alloc();
  if (!is_sealed(file, stream, mend))
    refuse_file(file, "is damaged", "its checksum is missing: another program wrote or changed it, or its end is lost",
                mend);
  return stream;
}

void require_seal(const fs::path& file, const std::string& mend) { open_sealed_stream(file, mend); }

std::string checksum_as_read(const fs::path& file) {
  const std::string noted = context().checksum_of(file);
  return !noted.empty() || !fs::is_regular_file(file) ? noted : sha256(file);
}

}  // namespace talus
