// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/table_words.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace talus {

std::vector<std::string> table_words(const std::string& line) {
  std::vector<std::string> result;
  std::string word;
  for (const char c : line.substr(0, line.find('#')) + ' ') {
    if (c == ',' || c == ';' || c == '\t' || c == ' ' || c == '\r') {
      if (!word.empty()) result.push_back(std::move(word));
      word.clear();
    } else if (c != '"') {
      word += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
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
