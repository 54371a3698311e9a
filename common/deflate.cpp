// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/deflate.hpp"

#include <memory>
#include <new>

#include <libdeflate.h>

namespace talus {

std::string deflated(std::span<const char> bytes, int effort) {
  const std::unique_ptr<libdeflate_compressor, void (*)(libdeflate_compressor*)> compressor(
      libdeflate_alloc_compressor(effort), libdeflate_free_compressor);
  if (!compressor) throw std::bad_alloc();
  std::string packed(libdeflate_zlib_compress_bound(compressor.get(), bytes.size()), '\0');
  packed.resize(libdeflate_zlib_compress(compressor.get(), bytes.data(), bytes.size(), packed.data(), packed.size()));
  return packed;
}

bool inflate_to(std::span<char> to, std::span<const char> packed) {
  const std::unique_ptr<libdeflate_decompressor, void (*)(libdeflate_decompressor*)> decompressor(
      libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  if (!decompressor) throw std::bad_alloc();
  return libdeflate_zlib_decompress(decompressor.get(), packed.data(), packed.size(), to.data(), to.size(), nullptr) ==
         LIBDEFLATE_SUCCESS;
}

std::uint32_t crc32_of(std::span<const char> bytes) { return libdeflate_crc32(0, bytes.data(), bytes.size()); }

}  // namespace talus
