// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/gis/vertical_unit.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

namespace talus {
namespace {

constexpr double foot = 0.3048;                     // international, exactly
constexpr double us_survey_foot = 1200.0 / 3937.0;  // exactly, by its definition of 1893

/// Lower case, words parted by single blanks: "US_Survey-Foot" becomes "us survey foot".
std::string plain(const std::string& unit) {
  std::string text;
  for (const char c : unit) {
    const auto u = static_cast<unsigned char>(c);
    const bool parts = std::isspace(u) != 0 || c == '_' || c == '-' || c == '(' || c == ')';
    if (!parts) text += static_cast<char>(std::tolower(u));
    if (parts && !text.empty() && text.back() != ' ') text += ' ';
  }
  while (!text.empty() && text.back() == ' ') text.pop_back();
  return text;
}

bool has(const std::string& text, std::string_view part) { return text.find(part) != std::string::npos; }

bool is_one_of(const std::string& text, std::initializer_list<std::string_view> names) {
  return std::find(names.begin(), names.end(), text) != names.end();
}

bool of_another_quantity(const std::string& text) {
  const bool words_only =
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalpha(c) != 0 || c == ' '; });
  return !words_only ||
         is_one_of(text, {"deg", "degree", "degrees", "rad", "radian", "radians", "pa", "kpa", "mpa", "s", "second",
                          "seconds", "none", "unknown", "unitless", "dimensionless", "n a", "percent"});
}

}  // namespace

std::optional<double> metres_in(const std::string& unit) {
  const std::string text = plain(unit);
  if (text.empty() || of_another_quantity(text)) return 1.0;
  if (has(text, "foot") || has(text, "feet") || is_one_of(text, {"ft", "ft us", "us ft", "sft", "ftus", "usft"}))
    return has(text, "us") || has(text, "u s") || has(text, "survey") || text == "sft" ? us_survey_foot : foot;
  if (text == "cm" || has(text, "centimet")) return 0.01;
  if (text == "dm" || has(text, "decimet")) return 0.1;
  if (text == "mm" || has(text, "millimet")) return 0.001;
  if (text == "km" || has(text, "kilomet")) return 1000.0;
  if (text == "m" || text.starts_with("metre") || text.starts_with("meter") || text.starts_with("m ")) return 1.0;
  return std::nullopt;
}

}  // namespace talus
