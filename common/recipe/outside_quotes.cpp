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

bool is_of_a_bare_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// What ends a value that stands in no quotes, as toml++ looks for it where the value is none.
bool ends_a_bare_value(char c) { return std::string_view(" \t\r\n,]}#").find(c) != std::string_view::npos; }

/// A walk over a text, which knows where a value is due: a quote begins a string only where a key or a value may begin.
/// Behind the letters of another value it is one of them.
class Walk {
 public:
  explicit Walk(const std::string& text) : text_(text) {}

  /// The place behind the token at `at`, which is ASCII.
  std::size_t after(std::size_t at) {
    const char c = text_[at];
    if (c == '"' || c == '\'') return after_quote(at);
    if (c == '#') return after_token(text_, at);
    if (c == ' ' || c == '\t' || c == '\r') return at + 1;
    if (c == '\n' || c == '=' || c == ',' || c == '[' || c == ']' || c == '{' || c == '}') {
      pass(c);
      return at + 1;
    }
    if (!value_is_due_) return at + 1;
    value_is_due_ = false;
    while (at < text_.size() && !ends_a_bare_value(text_[at]) && !is_beyond_ascii(text_[at])) ++at;
    return at;
  }

 private:
  std::size_t after_quote(std::size_t at) {
    if (!value_is_due_ && at > 0 && is_of_a_bare_key(text_[at - 1])) return at + 1;
    value_is_due_ = false;
    return after_token(text_, at);
  }

  void pass(char c) {
    if (c == '=') value_is_due_ = true;
    if (c == ',') value_is_due_ = !open_.empty() && open_.back() == '[';
    if (c == '\n' && open_.empty()) value_is_due_ = false;
    if (c == '[' && value_is_due_) open_.push_back(c);  // else the head of a table
    if (c == '{') {
      open_.push_back(c);
      value_is_due_ = false;
    }
    if (c == ']' || c == '}') {
      if (!open_.empty()) open_.pop_back();
      value_is_due_ = false;
    }
  }

  const std::string& text_;
  std::string open_;           ///< brackets
  bool value_is_due_ = false;  ///< behind '=', and in arrays
};

}  // namespace

std::optional<TextPlace> foreign_letter_outside_quotes(const std::string& text) {
  Walk walk(text);
  std::size_t at = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  while (at < text.size()) {
    if (is_beyond_ascii(text[at])) return place_of(text, at);
    at = walk.after(at);
  }
  return {};
}

}  // namespace talus::recipe
