// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/scene/table_words.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace talus::solver {

std::vector<std::string> words_of(const std::string& line) {
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

std::optional<double> number_in(const std::string& word) {
  const char* begin = word.data() + (word.starts_with('+') ? 1 : 0);
  const char* const behind = word.data() + word.size();
  double value = 0;
  const auto [end, error] = std::from_chars(begin, behind, value);
  if (error != std::errc() || end != behind || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace talus::solver
