// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/used.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "common/error.hpp"
#include "common/recipe/parsed.hpp"
#include "common/whole_text.hpp"

namespace talus::recipe {

std::size_t byte_of(std::string_view line, std::size_t column) {
  std::size_t at = 0;
  for (std::size_t passed = 1; passed < column && at < line.size(); ++passed) {
    do ++at;
    while (at < line.size() && (static_cast<unsigned char>(line[at]) & 0xC0U) == 0x80U);
  }
  return at;
}

namespace {

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t"), last = text.find_last_not_of(" \t");
  return first == std::string::npos ? "" : text.substr(first, last - first + 1);
}

class UsedReader {
 public:
  explicit UsedReader(const std::string& text) : lines_(lines_in(text)) {}

  UsedRecipe read(const toml::table& root) {
    facts();
    for (const auto& [name, node] : root)
      if (name.str() != "scene" && node.is_table()) table(std::string(name.str()), *node.as_table());
    std::sort(placed_.begin(), placed_.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    for (auto& [line, key] : placed_) used_.keys.push_back(std::move(key));
    return std::move(used_);
  }

 private:
  /// "# name: value" until the first line that is no comment.
  void facts() {
    for (const auto& line : lines_) {
      if (!line.starts_with('#')) return;
      const auto colon = line.find(": ");
      if (colon != std::string::npos)
        used_.facts.emplace_back(trimmed(line.substr(1, colon - 1)), line.substr(colon + 2));
    }
  }

  void table(const std::string& path, const toml::table& values) {
    for (const auto& [name, node] : values) {
      const auto below = path + "." + std::string(name.str());
      const auto* items = node.as_array();
      if (node.is_table())
        table(below, *node.as_table());
      else if (items != nullptr && !items->empty() && items->is_array_of_tables())
        for (std::size_t i = 0; i < items->size(); ++i)
          table(fmt::format("{} {}", below, i + 1), *items->get(i)->as_table());
      else
        value(path, std::string(name.str()), node);
    }
  }

  void value(const std::string& path, const std::string& key, const toml::node& node) {
    const auto& source = node.source();
    const auto& line = lines_.at(source.begin.line - 1);
    const auto begin = byte_of(line, source.begin.column), end = byte_of(line, source.end.column);
    UsedKey used{path, key, trimmed(line.substr(begin, end - begin)), {}};
    constexpr std::string_view mark = "# default: ";
    const auto rest = trimmed(line.substr(end));
    if (rest.starts_with(mark)) used.default_value = rest.substr(mark.size());
    placed_.emplace_back(source.begin.line, std::move(used));
  }

  std::vector<std::string> lines_;
  std::vector<std::pair<std::size_t, UsedKey>> placed_;
  UsedRecipe used_;
};

}  // namespace

UsedRecipe read_used_recipe(const std::string& text, const std::string& shown) {
  try {
    const toml::table root = toml::parse(text, shown);
    return UsedReader(text).read(root);
  } catch (const toml::parse_error& error) {
    throw DataError({fmt::format("{}:{}: not TOML", shown, error.source().begin.line), std::string(error.description()),
                     "Run its stage again"});
  }
}

}  // namespace talus::recipe
