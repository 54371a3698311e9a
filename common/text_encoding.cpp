// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/text_encoding.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace talus {

namespace {

constexpr char32_t replacement = 0xFFFD;

/// Of the bytes 0x80 to 0x9F; the others are those of Latin-1.
constexpr char32_t cp1252[] = {0x20AC,      replacement, 0x201A, 0x0192, 0x201E, 0x2026,      0x2020, 0x2021,
                               0x02C6,      0x2030,      0x0160, 0x2039, 0x0152, replacement, 0x017D, replacement,
                               replacement, 0x2018,      0x2019, 0x201C, 0x201D, 0x2022,      0x2013, 0x2014,
                               0x02DC,      0x2122,      0x0161, 0x203A, 0x0153, replacement, 0x017E, 0x0178};

char32_t of_cp1252(char32_t code) { return code >= 0x80 && code <= 0x9F ? cp1252[code - 0x80] : code; }

struct Decoded {
  char32_t code = 0;
  std::size_t bytes = 0;  ///< 0: they begin no character of UTF-8
};

/// The first character of bytes that are not empty.
Decoded decoded(std::string_view text) {
  const auto at = [&](std::size_t n) { return static_cast<std::uint8_t>(text[n]); };
  const std::uint8_t first = at(0);
  if (first < 0x80) return {first, 1};
  const std::size_t bytes = first >= 0xF0 ? 4 : first >= 0xE0 ? 3 : 2;
  if (first < 0xC2 || first > 0xF4 || text.size() < bytes) return {};
  char32_t code = first & (0x7Fu >> bytes);
  for (std::size_t n = 1; n < bytes; ++n) {
    if ((at(n) & 0xC0u) != 0x80) return {};
    code = code << 6 | (at(n) & 0x3Fu);
  }
  constexpr char32_t least[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool surrogate = code >= 0xD800 && code <= 0xDFFF;
  return code < least[bytes] || code > 0x10FFFF || surrogate ? Decoded{} : Decoded{code, bytes};
}

/// Appends a character below U+10000.
void append(std::string& text, char32_t code) {
  if (code < 0x80) {
    text += static_cast<char>(code);
  } else if (code < 0x800) {
    text += static_cast<char>(0xC0 | code >> 6);
    text += static_cast<char>(0x80 | (code & 0x3F));
  } else {
    text += static_cast<char>(0xE0 | code >> 12);
    text += static_cast<char>(0x80 | (code >> 6 & 0x3F));
    text += static_cast<char>(0x80 | (code & 0x3F));
  }
}

}  // namespace

bool is_utf8(std::string_view bytes) {
  while (!bytes.empty()) {
    const Decoded next = decoded(bytes);
    if (next.bytes == 0) return false;
    bytes.remove_prefix(next.bytes);
  }
  return true;
}

std::string as_utf8(std::string_view text) {
  const bool utf8 = is_utf8(text);
  std::string result;
  while (!text.empty()) {
    const Decoded next = utf8 ? decoded(text) : Decoded{static_cast<std::uint8_t>(text[0]), 1};
    const char32_t code = of_cp1252(next.code);
    if (code != next.code || !utf8)
      append(result, code);
    else
      result.append(text.substr(0, next.bytes));
    text.remove_prefix(next.bytes);
  }
  return result;
}

std::string as_cp1252(std::string_view utf8) {
  std::string result;
  for (Decoded next; !utf8.empty(); utf8.remove_prefix(std::max<std::size_t>(next.bytes, 1))) {
    next = decoded(utf8);
    const bool plain = next.code < 0x80 || (next.code >= 0xA0 && next.code <= 0xFF);
    const auto* const byte = std::ranges::find(cp1252, next.code);
    const bool known = next.bytes > 0 && next.code != replacement && (plain || byte != std::end(cp1252));
    result += !known ? '?' : static_cast<char>(plain ? next.code : 0x80 + static_cast<char32_t>(byte - cp1252));
  }
  return result;
}

std::string_view wide_encoding(std::string_view start) {
  using namespace std::string_view_literals;
  if (start.starts_with("\xFF\xFE\0\0"sv) || start.starts_with("\0\0\xFE\xFF"sv)) return "UTF-32";
  if (start.starts_with("\xFF\xFE"sv) || start.starts_with("\xFE\xFF"sv)) return "UTF-16";
  constexpr std::size_t least_pairs = 4, most_pairs = 32;
  const std::size_t pairs = std::min(start.size() / 2, most_pairs);
  if (pairs < least_pairs) return "";
  const auto is_text = [](unsigned char c) {
    return (c >= ' ' && c <= '~') || c >= 0xA0 || c == '\t' || c == '\n' || c == '\r';
  };
  const auto all = [&](std::size_t zero) {  // heights as binary integers have zeros between bytes too
    for (std::size_t n = 0; n < 2 * pairs; ++n)
      if (n % 2 == zero ? start[n] != '\0' : !is_text(static_cast<unsigned char>(start[n]))) return false;
    return true;
  };
  return all(1) ? "UTF-16LE" : all(0) ? "UTF-16BE" : "";
}

std::string mend_of_encoding(std::string_view encoding, const std::string& file) {
  const std::filesystem::path path(file);
  const std::string out = (path.parent_path() / (path.stem().string() + "-utf8" + path.extension().string())).string();
  return fmt::format("Save it as UTF-8, or convert it: iconv -f {} -t UTF-8 {} > {}", encoding, file, out);
}

}  // namespace talus
