// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/table_words.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace talus {

namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }

/// Whether the comma at n stands between digits.
bool is_within_number(std::string_view text, std::size_t n) {
  return text[n] == ',' && n > 0 && is_digit(text[n - 1]) && n + 1 < text.size() && is_digit(text[n + 1]);
}

/// Whether a word between blanks can be a number with a decimal comma, or has no comma at all.
bool has_no_other_comma(std::string_view word) {
  const std::size_t comma = word.find(',');
  return comma == std::string_view::npos ||
         (is_within_number(word, comma) && word.find_first_of(".,", comma + 1) == std::string_view::npos &&
          word.find('.') == std::string_view::npos);
}

/// Whether commas between digits are decimal points: semicolons part the words, or blanks do, and no comma is left that
/// would have to.
bool commas_are_decimal(std::string_view text) {
  if (text.find(';') != std::string_view::npos) return true;
  std::size_t words = 0;
  for (std::size_t first = 0; first < text.size();) {
    if (is_blank(text[first])) {
      ++first;
      continue;
    }
    std::size_t end = first;
    while (end < text.size() && !is_blank(text[end])) ++end;
    if (!has_no_other_comma(text.substr(first, end - first))) return false;
    first = end;
    ++words;
  }
  return words > 1;
}

}  // namespace

std::vector<std::string> table_words(const std::string& line) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  std::string_view text = std::string_view(line).substr(0, line.find('#'));
  if (text.starts_with(byte_order_mark)) text.remove_prefix(byte_order_mark.size());
  const bool decimal_commas = commas_are_decimal(text);
  std::vector<std::string> result;
  std::string word;
  const auto end_word = [&] {
    if (!word.empty()) result.push_back(std::move(word));
    word.clear();
  };
  for (std::size_t n = 0; n < text.size(); ++n) {
    const char c = text[n];
    if (decimal_commas && is_within_number(text, n))
      word += '.';
    else if (c == ',' || c == ';' || is_blank(c))
      end_word();
    else if (c != '"')
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  }
  end_word();
  return result;
}

std::optional<double> finite_number(std::string_view word) {
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

std::optional<double> signed_number(std::string_view word) {
  return finite_number(word.starts_with('+') ? word.substr(1) : word);
}

}  // namespace talus
