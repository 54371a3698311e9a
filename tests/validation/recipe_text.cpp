// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/validation/recipe_text.hpp"

#include <fmt/format.h>

#include <regex>
#include <sstream>
#include <stdexcept>
#include <string_view>

#include "common/recipe/toml.hpp"

namespace talus::validation {
namespace {

struct Step {
  std::string key;
  int item = -1;  // of an array of tables
};

std::vector<Step> steps_of(const std::string& path) {
  std::vector<Step> steps;
  std::istringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    const auto bracket = part.find('[');
    if (bracket == std::string::npos) {
      steps.push_back({part});
    } else {
      steps.push_back({part.substr(0, bracket), std::stoi(part.substr(bracket + 1))});
    }
  }
  return steps;
}

toml::table& descend(toml::table& from, const Step& step, const std::string& path) {
  const auto refuse = [&](const char* why) { throw std::runtime_error("recipe key " + path + ": " + why); };
  if (step.item < 0) {
    auto* table = from.insert(step.key, toml::table{}).first->second.as_table();
    if (table == nullptr) refuse("not a table");
    return *table;
  }
  auto* array = from.insert(step.key, toml::array{}).first->second.as_array();
  if (array == nullptr) refuse("not an array of tables");
  const auto item = static_cast<std::size_t>(step.item);
  if (item == array->size()) array->push_back(toml::table{});
  auto* table = item < array->size() ? (*array)[item].as_table() : nullptr;
  if (table == nullptr) refuse("no such item");
  return *table;
}

struct Assign {
  toml::table& table;
  const Step& step;
  template <class T>
  void operator()(const T& value) const {
    if (step.item < 0) {
      table.insert_or_assign(step.key, value);
    } else {
      toml::array* list = table[step.key].as_array();
      if (list == nullptr || static_cast<std::size_t>(step.item) >= list->size())
        throw std::runtime_error("recipe key " + step.key + ": no such item");
      list->replace(list->begin() + step.item, value);
    }
  }
  template <class T>
  void operator()(const std::vector<T>& values) const {
    toml::array array;
    for (const T& value : values) array.push_back(value);
    table.insert_or_assign(step.key, array);
  }
};

/// Numbers as people write them: 0.0225 for 0.022499999999999999. The value stays the same.
std::string with_short_numbers(const std::string& text) {
  static const std::regex number(R"(-?\d+\.\d{8,}(e[-+]?\d+)?)");
  std::string result;
  auto from = text.begin();
  for (std::sregex_iterator match(text.begin(), text.end(), number), end; match != end; ++match) {
    result.append(from, (*match)[0].first);
    const std::string shortest = fmt::format("{}", std::stod(match->str()));
    result += shortest.find_first_of(".e") == std::string::npos ? shortest + ".0" : shortest;
    from = (*match)[0].second;
  }
  return result.append(from, text.end());
}

}  // namespace

std::string recipe_with(const std::filesystem::path& base, const Overrides& overrides) {
  toml::table recipe = toml::parse_file(base.string());
  for (const auto& [path, value] : overrides) {
    const auto steps = steps_of(path);
    toml::table* table = &recipe;
    for (std::size_t s = 0; s + 1 < steps.size(); ++s) table = &descend(*table, steps[s], path);
    std::visit(Assign{*table, steps.back()}, value);
  }
  std::ostringstream text;
  text << recipe << '\n';
  return with_short_numbers(text.str());
}

Overrides operator+(Overrides a, const Overrides& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

}  // namespace talus::validation
