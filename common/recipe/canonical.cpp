// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A table of a recipe in one way of writing: what two recipes share that say the same in other words.
#include <fmt/format.h>

#include <sstream>

#include "common/recipe/parsed.hpp"
#include "common/recipe/values.hpp"

namespace talus::recipe {
namespace {

void append(const toml::node& node, std::string& text);

void append(const toml::table& table, std::string& text) {
  text += '{';
  for (const auto& [key, value] : table) {  // by name, whatever the order in the file
    text += toml_text(key.str()) + ":";
    append(value, text);
    text += ',';
  }
  text += '}';
}

void append(const toml::array& array, std::string& text) {
  text += '[';
  for (const toml::node& item : array) {
    append(item, text);
    text += ',';
  }
  text += ']';
}

/// 5 and 5.0 are the same number.
void append(const toml::node& node, std::string& text) {
  if (const auto* table = node.as_table()) {
    append(*table, text);
  } else if (const auto* array = node.as_array()) {
    append(*array, text);
  } else if (const auto* word = node.as_string()) {
    text += toml_text(word->get());
  } else if (const auto* flag = node.as_boolean()) {
    text += flag->get() ? "true" : "false";
  } else if (const auto* count = node.as_integer()) {
    text += toml_number(static_cast<double>(count->get()));
  } else if (const auto* number = node.as_floating_point()) {
    text += toml_number(number->get());
  } else {
    std::ostringstream stream;
    node.visit([&](const auto& value) { stream << value; });
    text += stream.str();
  }
}

}  // namespace

std::optional<std::string> Recipe::canonical(std::string_view table) const {
  const toml::table* found = parsed_->root[table].as_table();
  if (found == nullptr) return std::nullopt;
  std::string text;
  append(*found, text);
  return text;
}

}  // namespace talus::recipe
