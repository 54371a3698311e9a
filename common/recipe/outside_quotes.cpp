// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/outside_quotes.hpp"

#include <string_view>

namespace talus::recipe {
namespace {

constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";

bool is_beyond_ascii(char c) { return static_cast<unsigned char>(c) >= 0x80; }
bool continues_a_character(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

/// The end of the comment or string that begins at `at`, or the next character where none does.
std::size_t after_token(const std::string& text, std::size_t at) {
  const std::string_view all = text;
  const auto end_of = [&](std::size_t found, std::size_t length) {
    return found == std::string_view::npos ? all.size() : found + length;
  };
  const char c = all[at];
  if (c == '#') return end_of(all.find('\n', at), 0);
  if (c != '"' && c != '\'') return at + 1;
  const std::string three(3, c);
  const bool long_one = all.substr(at, 3) == three;
  std::size_t next = at + (long_one ? 3 : 1);
  for (; next < all.size(); ++next) {
    if (c == '"' && all[next] == '\\') {
      ++next;  // and what it escapes
    } else if (long_one && all.substr(next, 3) == three) {
      next += 3;
      while (next < all.size() && all[next] == c) ++next;  // up to two quotes may stand before the end
      return next;
    } else if (!long_one && (all[next] == c || all[next] == '\n')) {
      return next + 1;
    }
  }
  return all.size();
}

TextPlace place_of(const std::string& text, std::size_t at) {
  TextPlace place;
  for (std::size_t n = 0; n < at; ++n) {
    if (text[n] == '\n') {
      ++place.line;
      place.column = 1;
    } else if (!continues_a_character(text[n])) {
      ++place.column;
    }
  }
  return place;
}

}  // namespace

std::optional<TextPlace> foreign_letter_outside_quotes(const std::string& text) {
  std::size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  while (at < text.size()) {
    if (is_beyond_ascii(text[at])) return place_of(text, at);
    at = after_token(text, at);
  }
  return {};
}

}  // namespace talus::recipe
