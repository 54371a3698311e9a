// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/recipe.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstddef>
#include <optional>

#include "common/recipe/parsed.hpp"

namespace talus::recipe {
namespace {

/// A step on the way down: the name of a key, or the number of an item.
struct Step {
  std::string name;  // empty: an item
  std::size_t item = 0;
};
using Steps = std::vector<Step>;

/// Thrown while one value is put in, caught for each.
struct Unusable {
  std::string why, mend;
};

constexpr const char* form = "Write --set key=value, the key with its tables: --set solve.end_time_s=60";

bool of_a_key(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
}

/// "part[0].release" -> part, 0, release.
Steps steps_of(std::string_view key) {
  Steps steps;
  std::size_t at = 0;
  do {
    const std::size_t begin = at;
    while (at < key.size() && of_a_key(key[at])) ++at;
    if (at == begin) throw Unusable{"this is no key", form};
    steps.push_back({std::string(key.substr(begin, at - begin))});
    while (at < key.size() && key[at] == '[') {
      std::size_t item = 0;
      const auto [end, error] = std::from_chars(key.data() + at + 1, key.data() + key.size(), item);
      at = static_cast<std::size_t>(end - key.data());
      if (error != std::errc{} || at == key.size() || key[at] != ']')
        throw Unusable{"this is no key", "Give the number of an item, counted from 0: --set 'solve.part[0].release=A'"};
      ++at;
      steps.push_back({"", item});
    }
  } while (at < key.size() && key[at++] == '.');
  if (at < key.size() || key.back() == '.') throw Unusable{"this is no key", form};
  return steps;
}

/// "solve.part[0]"
std::string text_of(const Steps& steps, std::size_t count) {
  std::string text;
  for (std::size_t i = 0; i < count; ++i)
    text += steps[i].name.empty() ? fmt::format("[{}]", steps[i].item) : (i == 0 ? "" : ".") + steps[i].name;
  return text;
}

/// The value as the one key of a table, from a text of TOML; none where the text is none.
std::optional<toml::table> parsed(const std::string& line, const std::string& shown, std::string& why) {
  if (line.find_first_of("\n\r") != std::string::npos) why = "it has more than one line";
  if (!why.empty()) return std::nullopt;
  try {
    return toml::parse(line, shown);
  } catch (const toml::parse_error& error) {
    why = std::string(error.description());
    return std::nullopt;
  }
}

/// The tables of `names` below one another, the value innermost.
toml::table value_below(const std::string& names, const std::string& value, const std::string& shown) {
  std::string why;
  if (auto table = parsed(names + " = " + value, shown, why)) return std::move(*table);
  const auto first = value.find_first_not_of(" \t");
  if (first != std::string::npos && std::string_view("\"'[{").find(value[first]) != std::string_view::npos)
    throw Unusable{"the value is not TOML: " + why, "Mend the value; the format is described on https://toml.io"};
  why.clear();
  if (auto text = parsed(names + " = " + toml_text(value), shown, why)) return std::move(*text);
  throw Unusable{"the value is not TOML: " + why, "Mend the value; the format is described on https://toml.io"};
}

/// What the first `count` steps lead to, all of which must be there.
toml::node& existing(toml::table& root, const Steps& steps, std::size_t count) {
  toml::node* at = &root;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string so_far = text_of(steps, i);
    if (!steps[i].name.empty()) {
      toml::table* table = at->as_table();
      at = table == nullptr ? nullptr : table->get(steps[i].name);
      if (at == nullptr)
        throw Unusable{fmt::format("the recipe has no list {}", text_of(steps, i + 1)),
                       fmt::format("Give the whole list: --set '{}=[...]'", text_of(steps, i + 1))};
      continue;
    }
    toml::array* list = at->as_array();
    if (list == nullptr) throw Unusable{so_far + " is no list", "Leave the [] out"};
    if (steps[i].item >= list->size())
      throw Unusable{
          fmt::format("{} has {} {}, counted from 0", so_far, list->size(), list->size() == 1 ? "item" : "items"),
          "Name one that is there, or add it to the recipe"};
    at = list->get(steps[i].item);
  }
  return *at;
}

/// `from` is a table in a table ... with one key each; its innermost value takes its place in `into`, `depth` below.
void put(toml::table& into, toml::table&& from, std::size_t depth, const std::string& so_far) {
  auto first = from.begin();
  const toml::key& key = first->first;
  toml::node& value = first->second;
  toml::node* there = into.get(key.str());
  if (depth > 0 && there != nullptr) {
    const std::string here = so_far + (so_far.empty() ? "" : ".") + std::string(key.str());
    if (there->as_table() == nullptr)
      throw Unusable{here + (there->is_array() ? " is a list" : " is no table"),
                     there->is_array() ? fmt::format("Name one of its items, counted from 0: {}[0]", here)
                                       : "Leave out what comes behind it"};
    return put(*there->as_table(), std::move(*value.as_table()), depth - 1, here);
  }
  into.insert_or_assign(toml::key(key), std::move(value));
}

void apply(toml::table& root, const std::string& override, const std::string& shown) {
  const auto sign = override.find('=');
  if (sign == std::string::npos) throw Unusable{"there is no value", form};
  const Steps steps = steps_of(std::string_view(override).substr(0, sign));
  const std::string value = override.substr(sign + 1);
  const auto is_item = [](const Step& step) { return step.name.empty(); };
  const auto reached =
      static_cast<std::size_t>(std::find_if(steps.rbegin(), steps.rend(), is_item).base() - steps.begin());
  if (reached == steps.size()) {  // an item itself
    toml::array& list = *existing(root, steps, reached - 1).as_array();
    existing(root, steps, reached);
    toml::table item = value_below("item", value, shown);
    const auto place = list.begin() + static_cast<std::ptrdiff_t>(steps.back().item);
    list.replace(place, std::move(item.begin()->second));
    return;
  }
  toml::table* table = existing(root, steps, reached).as_table();
  if (table == nullptr) throw Unusable{text_of(steps, reached) + " is no table", "Leave out what comes behind it"};
  std::string names;
  for (std::size_t i = reached; i < steps.size(); ++i) names += (i == reached ? "" : ".") + steps[i].name;
  put(*table, value_below(names, value, shown), steps.size() - reached - 1, text_of(steps, reached));
}

}  // namespace

void apply_overrides(toml::table& root, const std::vector<std::string>& overrides) {
  std::vector<Fault> faults;
  for (const std::string& override : overrides) {
    const std::string shown = std::string(set_mark) + override;
    try {
      apply(root, override, shown);
    } catch (const Unusable& unusable) {
      faults.push_back({shown, unusable.why, unusable.mend});
    }
  }
  if (!faults.empty()) throw RecipeError(std::move(faults));
}

}  // namespace talus::recipe
