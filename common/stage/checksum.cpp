// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 by libcrypto, which takes the processor's own instructions where it has them.
#include "common/stage/checksum.hpp"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <new>
#include <optional>
#include <stdexcept>
#include <system_error>
#include <vector>

#include <fmt/format.h>
#include <openssl/evp.h>

#include "common/stage/context.hpp"
#include "common/stage/files.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace fs = std::filesystem;
namespace {

void require_success(int answer) {
  if (answer != 1) throw std::runtime_error("libcrypto gives no SHA-256");
}

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

/// Whether an open file is sealed; see check_seal(). Notes the checksum of the whole file where it is.
bool is_sealed(const fs::path& file, std::ifstream& stream, const std::string& mend) {
  std::error_code error;
  const std::uint64_t size = fs::is_regular_file(file, error) ? fs::file_size(file, error) : 0;
  if (error || size < seal_size) return false;
  errno = 0;
  std::string end(seal_size, '\0');
  stream.seekg(static_cast<std::streamoff>(size - seal_size));
  if (!stream.read(end.data(), seal_size)) refuse_file(file, "cannot be read", reason_of(errno), mend);
  const auto seal = seal_in(end);
  if (!seal) return false;
  if (seal->length != size - seal_size)
    refuse_file(file, "is damaged",
                fmt::format("it holds {} bytes, its last line speaks of {}", size - seal_size, seal->length), mend);
  stream.seekg(0);
  auto sum = sum_of(stream, seal->length);
  if (!sum) refuse_file(file, "cannot be read", reason_of(errno), mend);
  Sha256 whole = *sum;
  whole.add({reinterpret_cast<const std::uint8_t*>(end.data()), end.size()});
  if (const std::string digest = sum->digest(); digest != seal->digest)
    refuse_file(file, "is damaged",
                fmt::format("bytes have changed since it was written: its SHA-256 is {}..., its last line says {}...",
                            digest.substr(0, 12), seal->digest.substr(0, 12)),
                mend);
  context().note_checksum(file, whole.digest());
  stream.seekg(0);
  return true;
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  if (!context_) throw std::bad_alloc();
  require_success(EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr));
}

Sha256::Sha256(const Sha256& other) : Sha256() {
  require_success(EVP_MD_CTX_copy_ex(context_.get(), other.context_.get()));
}

void Sha256::add(std::span<const std::uint8_t> bytes) {
  require_success(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()));
}

std::string Sha256::digest() {
  unsigned char bytes[EVP_MAX_MD_SIZE];
  unsigned count = 0;
  require_success(EVP_DigestFinal_ex(context_.get(), bytes, &count));
  std::string text;
  for (unsigned i = 0; i < count; ++i) {
    text += "0123456789abcdef"[bytes[i] >> 4];
    text += "0123456789abcdef"[bytes[i] & 0xf];
  }
  return text;
}

std::string sha256(const std::filesystem::path& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  Sha256 sum;
  std::vector<std::uint8_t> part(Sha256::read_at_once);
  do {
    stream.read(reinterpret_cast<char*>(part.data()), static_cast<std::streamsize>(part.size()));
    sum.add(std::span(part).first(static_cast<std::size_t>(stream.gcount())));
  } while (stream);
  if (stream.bad() || !stream.eof())
    throw DataError({path.string() + ": cannot be read", reason_of(errno), "Check the path and its permissions"});
  return sum.digest();
}

std::string sha256_of_text(const std::string& text) {
  Sha256 sum;
  sum.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return sum.digest();
}

void seal_file(const fs::path& file, const fs::path& shown) {
  errno = 0;
  std::error_code error;
  SealLine seal{"", fs::file_size(file, error)};
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary);
  auto sum = error ? std::nullopt : sum_of(stream, seal.length);
  if (!sum) throw DataError(write_fault(shown, error ? error.message() : reason_of(errno)));
  seal.digest = sum->digest();
  stream.clear();
  stream.seekp(0, std::ios::end);
  stream << text_of(seal);
  stream.close();
  if (!stream) throw DataError(write_fault(shown, reason_of(errno)));
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
