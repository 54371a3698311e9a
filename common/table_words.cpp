// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/table_words.hpp"

#include <algorithm>
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

std::vector<TableWord> placed_words(const std::string& line) {
  constexpr std::string_view byte_order_mark = "\xEF\xBB\xBF";
  const std::string_view text = std::string_view(line).substr(0, line.find('#'));
  const std::size_t first = text.starts_with(byte_order_mark) ? byte_order_mark.size() : 0;
  const bool decimal_commas = commas_are_decimal(text.substr(first));
  std::vector<TableWord> result;
  TableWord word;
  const auto end_word = [&] {
    if (!word.text.empty()) result.push_back(std::move(word));
    word = {};
  };
  for (std::size_t n = first; n < text.size(); ++n) {
    const char c = text[n];
    const bool decimal = decimal_commas && is_within_number(text, n);
    if (!decimal && (c == ',' || c == ';' || is_blank(c))) {
      end_word();
    } else if (c != '"') {
      if (word.text.empty()) word.column = n + 1 - first;
      word.text += decimal ? '.' : static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
      word.written += c;
    }
  }
  end_word();
  return result;
}

std::vector<std::string> table_words(const std::string& line) {
  std::vector<std::string> result;
  for (TableWord& word : placed_words(line)) result.push_back(std::move(word.text));
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

bool is_grouped(std::string_view word) {
  constexpr std::string_view no_break[] = {"\u00A0", "\u202F", "\u2009", "\u2019"};
  std::string plain(word);
  for (const std::string_view sign : no_break)
    for (std::size_t at; (at = plain.find(sign)) != std::string::npos;) plain.replace(at, sign.size(), "'");
  if (plain.starts_with('-') || plain.starts_with('+')) plain.erase(0, 1);
  return !plain.empty() && is_digit(plain.front()) && plain.find_first_not_of("0123456789.,' \xA0") == plain.npos &&
         plain.find_first_of(".,' \xA0") != plain.npos && !finite_number(plain);
}

namespace {

constexpr std::size_t group = 3;  ///< digits between two signs that part thousands

std::string_view unsigned_part(std::string_view word) {
  return word.starts_with('-') || word.starts_with('+') ? word.substr(1) : word;
}

std::size_t digits_before(std::string_view word, std::size_t end) {
  return end <= word.size() && std::ranges::all_of(word.substr(0, end), is_digit) ? end : 0;
}

/// Whether a word can be the digits before the first sign that parts thousands: one to three, of which the first is
/// no 0.
bool begins_groups(std::string_view word) {
  const std::string_view digits = unsigned_part(word);
  return !digits.empty() && digits.size() <= group && digits[0] != '0' && digits_before(digits, digits.size()) > 0;
}

/// Whether a word begins with just three digits.
bool goes_on_with_group(std::string_view word) {
  return digits_before(word, group) > 0 && (word.size() == group || !is_digit(word[group])) &&
         (word.size() == group || word[group] == '.' || word[group] == ',');
}

/// Whether what stands between two words of a line are blanks alone; the words lie `from` and `to`.
bool blanks_between(const std::string& text, std::size_t from, std::size_t to) {
  return to > from && text.substr(from, to - from).find_first_not_of(' ') == std::string::npos;
}

/// Where a word and the next begin and end in their line, from 0.
std::size_t end_of(const TableWord& word) { return word.column - 1 + word.written.size(); }

}  // namespace

std::optional<NumberDoubt> NumberDoubts::look(std::string_view written, int line, std::size_t column) {
  const std::string_view digits = unsigned_part(written);
  const std::size_t comma = digits.find(',');
  const bool has_comma = comma != std::string_view::npos, has_point = digits.find('.') != std::string_view::npos;
  if (has_comma && has_point) return std::nullopt;  // no number, or words that commas part
  point_ = point_ || has_point;
  comma_ = comma_ || has_comma;
  NumberDoubt doubt{line, column, std::string(written), "", ""};
  if (point_ && comma_ && (has_comma || has_point)) {
    doubt.why = "the table has decimal commas and decimal points: one of them may part thousands";
    doubt.mend = "Write all numbers with a point, and thousands without a sign";
    return doubt;
  }
  if (!has_comma) return std::nullopt;
  const bool grouped = begins_groups(digits.substr(0, comma)) && digits.size() == comma + 1 + group &&
                       digits_before(digits.substr(comma + 1), group) > 0;
  settled_ = settled_ || !grouped;
  if (grouped && !group_) {
    std::string plain(written), point(written);
    plain.erase(plain.find(','), 1);
    point[point.find(',')] = '.';
    doubt.why = "it is " + point + ", or " + plain + " with a sign that parts thousands; no number of the table tells";
    doubt.mend = "Write " + point + " or " + plain + ", and the others likewise";
    group_ = std::move(doubt);
  }
  return std::nullopt;
}

std::optional<NumberDoubt> NumberDoubts::look(const std::vector<TableWord>& words, const std::string& text, int line) {
  const bool other =
      text.find_first_of(";\t") != std::string::npos || std::ranges::any_of(words, [&](const TableWord& word) {
        const std::size_t end = end_of(word);
        return end < text.size() && text[end] == ',';
      });
  for (std::size_t n = 0; other && n + 1 < words.size(); ++n) {
    const TableWord &one = words[n], &next = words[n + 1];
    const std::size_t from = end_of(one), to = next.column - 1;
    if (to != from + 1 || !blanks_between(text, from, to) || !begins_groups(one.written) ||
        !goes_on_with_group(next.written))
      continue;
    return NumberDoubt{line, one.column, one.written + " " + next.written,
                       "the blank parts thousands, or two numbers between which another separator is wanted",
                       "Write thousands without a sign"};
  }
  return std::nullopt;
}

std::optional<NumberDoubt> NumberDoubts::left() const { return settled_ ? std::nullopt : group_; }

std::size_t grouped_by_comma(const std::vector<TableWord>& words, const std::string& text) {
  for (std::size_t n = 0; n + 1 < words.size(); ++n) {
    const std::size_t from = end_of(words[n]);
    if (words[n + 1].column == from + 2 && text[from] == ',' && begins_groups(words[n].written) &&
        goes_on_with_group(words[n + 1].written))
      return words[n].column;
  }
  return 0;
}

}  // namespace talus
