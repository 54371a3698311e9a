// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/edited.hpp"

#include <optional>
#include <sstream>
#include <string_view>

#include "common/recipe/parsed.hpp"

namespace talus::recipe {
namespace {

/// Where a place of toml++, which counts from 1, begins in a text.
std::size_t place_in(const std::string& text, const toml::source_position& position) {
  std::size_t line = 0;
  for (toml::source_index passed = 1; passed < position.line; ++passed) line = text.find('\n', line) + 1;
  return line + byte_of(std::string_view(text).substr(line), position.column);
}

std::optional<toml::table> parsed_toml(const std::string& text) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error&) {
    return std::nullopt;
  }
}

/// What stands behind the sign of an override, as TOML.
std::string as_toml(const std::string& value) { return parsed_toml("value = " + value) ? value : toml_text(value); }

/// The text with one value put in; as it was where no place is found.
std::string with_value(const std::string& text, const toml::table& root, const std::string& key,
                       const std::string& value) {
  if (const auto node = toml::at_path(root, key); node && !node.is_table()) {
    const auto begin = place_in(text, node.node()->source().begin), end = place_in(text, node.node()->source().end);
    return text.substr(0, begin) + value + text.substr(end);
  }
  for (auto dot = key.rfind('.'); dot != std::string::npos && dot > 0; dot = key.rfind('.', dot - 1)) {
    const std::string table = key.substr(0, dot), head = "[" + table + "]";
    for (std::size_t line = 0; line < text.size(); line = text.find('\n', line) + 1) {
      const auto end = text.find('\n', line);
      if (text.compare(line, head.size(), head) == 0 && end != std::string::npos)
        return text.substr(0, end + 1) + key.substr(dot + 1) + " = " + value + "\n" + text.substr(end + 1);
      if (end == std::string::npos) break;
    }
  }
  const auto dot = key.rfind('.');
  if (dot == std::string::npos) return text;
  return text + "\n[" + key.substr(0, dot) + "]\n" + key.substr(dot + 1) + " = " + value + "\n";
}

}  // namespace

std::string edited(const std::string& text, const std::vector<std::string>& values) {
  toml::table wanted = *parsed_toml(text);
  apply_overrides(wanted, values);
  std::string now = text;
  for (const std::string& one : values) {
    const auto sign = one.find('=');
    const auto root = parsed_toml(now);
    if (!root) break;
    now = with_value(now, *root, one.substr(0, sign), as_toml(one.substr(sign + 1)));
  }
  if (const auto root = parsed_toml(now); root && *root == wanted) return now;
  std::ostringstream anew;
  anew << wanted << "\n";
  return anew.str();
}

}  // namespace talus::recipe
