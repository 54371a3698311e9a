// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// SHA-256 by libcrypto, which takes the processor's own instructions where it has them.
#include <openssl/evp.h>

#include <cerrno>
#include <fstream>
#include <new>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "common/stage/checksum.hpp"
#include "common/stage/stage.hpp"

namespace talus {
namespace {

void require_success(int answer) {
  if (answer != 1) throw std::runtime_error("libcrypto gives no SHA-256");
}

}  // namespace

void Sha256::Free::operator()(evp_md_ctx_st* context) const { EVP_MD_CTX_free(context); }

Sha256::Sha256() : context_(EVP_MD_CTX_new()) {
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
    throw DataError({path.string() + ": cannot be read", std::generic_category().message(errno),
                     "Check the path and its permissions"});
  return sum.digest();
}

std::string sha256_of_text(const std::string& text) {
  Sha256 sum;
  sum.add({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
  return sum.digest();
}

}  // namespace talus
