// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>

namespace talus {
namespace {

/// Of more faults than this, those beyond the first 50 are counted. A recipe's own list ends at 50 and its count.
constexpr std::size_t most_faults = 60, shown_faults = 50;

std::vector<Fault> bounded(std::vector<Fault> faults) {
  if (faults.size() <= most_faults) return faults;
  const std::size_t rest = faults.size() - shown_faults;
  faults.erase(faults.begin() + shown_faults, faults.end());
  faults.push_back({std::to_string(rest) + " more faults", "", "Mend those above first"});
  return faults;
}

std::string join(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += (text.empty() ? "" : "\n") + to_string(fault);
  return text;
}

}  // namespace

std::string to_string(const Fault& fault) {
  std::string text = fault.what;
  if (!fault.why.empty()) text += " (" + fault.why + ")";
  if (!fault.mend.empty()) text += ". " + fault.mend;
  return with_short_numbers(text);
}

std::string with_short_numbers(const std::string& text) {
  constexpr std::size_t most_digits = 18;
  const auto is_digit = [](char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; };
  const auto is_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '/'; };
  std::string result;
  for (std::size_t i = 0; i < text.size();) {
    if (!is_digit(text[i]) || (i > 0 && (is_word(text[i - 1]) || text[i - 1] == '.'))) {
      result += text[i++];
      continue;
    }
    std::size_t end = i;
    while (end < text.size() &&
           (is_digit(text[end]) || (text[end] == ',' && end + 1 < text.size() && is_digit(text[end + 1]))))
      ++end;
    std::string digits = text.substr(i, end - i);
    std::erase(digits, ',');
    if (end < text.size() && text[end] == '.')
      for (++end; end < text.size() && is_digit(text[end]);) ++end;
    const bool short_enough = digits.size() <= most_digits || (end < text.size() && is_word(text[end]));
    result += short_enough ? text.substr(i, end - i) : fmt::format("{:.4g}", std::strtod(digits.c_str(), nullptr));
    i = end;
  }
  return result;
}

Error::Error(ExitCode code, std::vector<Fault> faults)
    : std::runtime_error(join(bounded(faults))), code_(code), faults_(bounded(std::move(faults))) {}

}  // namespace talus
