// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Packing of bytes, by libdeflate: at the same size three times as fast as zlib.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace talus {

/// The bytes as a zlib stream (RFC 1950). Effort: 1, the fastest, to 12.
std::string deflated(std::span<const char> bytes, int effort);

/// Unpacks a zlib stream; returns false where it does not hold exactly the bytes of `to`.
bool inflate_to(std::span<char> to, std::span<const char> packed);

/// The CRC-32 of bytes (ISO 3309), as PNG asks for.
std::uint32_t crc32_of(std::span<const char> bytes);

}  // namespace talus
