// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/parsed.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "common/recipe/gone_keys.hpp"
#include "common/recipe/recipe.hpp"
#include "common/recipe/suggest.hpp"

namespace talus::recipe {
namespace {

/// A recipe with more faults than this is another file, or was broken by a program: the rest is counted.
constexpr std::size_t most_faults = 50;

bool contains(const std::vector<std::string>& words, std::string_view word) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

}  // namespace

std::string value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return toml_text(text->get());
  if (const auto* number = node.as_floating_point()) return toml_number(number->get());
  if (const auto* integer = node.as_integer()) return fmt::format("{}", integer->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  return "";
}

std::string kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table: return "a table";
    case toml::node_type::array: return "a list";
    case toml::node_type::string: return "text";
    case toml::node_type::integer: return "an integer";
    case toml::node_type::floating_point: return "a number with a decimal point";
    case toml::node_type::boolean: return "true or false";
    default: return "a date or time";
  }
}

Walk::Walk(const toml::table& root, std::string shown, std::vector<Fault>& faults)
    : shown_(std::move(shown)), out_(faults), frames_{Frame{&root}} {}

void Walk::push_table(std::string_view key) {
  const auto* node = find(key);
  Frame frame;
  frame.path = frames_.back().path + (frames_.back().path.empty() ? "" : ".") + std::string(key);
  frame.name = fmt::format("[{}]", frame.path);
  if (node != nullptr) {
    frame.table = node->as_table();
    if (frame.table == nullptr)
      add(*node, key, "a table is wanted",
          fmt::format("Write {} on a line of its own and the keys below it", frame.name));
  }
  frames_.push_back(std::move(frame));
}

void Walk::push_item(std::size_t item) {
  const List& list = lists_.back();
  const toml::table* table = list.items == nullptr ? nullptr : list.items->get(item)->as_table();
  frames_.push_back({table, fmt::format("[[{}]]", list.path), list.path});
}

void Walk::pop_table() {
  const Frame& frame = frames_.back();
  for (const auto& key : frame.known) all_known_.emplace(key, frame.name);
  if (frame.table != nullptr)
    for (const auto& [key, node] : *frame.table) {
      if (contains(frame.known, key.str())) continue;
      if (unknown_.size() < most_faults)
        unknown_.push_back({std::string(key.str()), frame.name, frame.path, key.source(), frame.known});
      else
        ++left_out_;
    }
  frames_.pop_back();
}

std::size_t Walk::push_list(std::string_view key, std::size_t size) {
  const auto* node = find(key);
  lists_.push_back({nullptr, frames_.back().path + "." + std::string(key)});
  if (node == nullptr) return size;
  const auto is_table = [](const toml::node& item) { return item.is_table(); };
  const auto* array = node->as_array();
  if (array == nullptr || !std::all_of(array->begin(), array->end(), is_table)) {
    add(*node, key, "a list of tables is wanted",
        fmt::format("Write [[{}]] above the keys of each one", lists_.back().path));
    return size;
  }
  lists_.back().items = array;
  return array->size();
}

const toml::node* Walk::find(std::string_view key) {
  Frame& frame = frames_.back();
  if (!contains(frame.known, key)) frame.known.emplace_back(key);
  return frame.table == nullptr ? nullptr : frame.table->get(key);
}

std::string_view Walk::advice_on_word(std::string_view key, std::string_view word) const {
  return advice_on_gone(fmt::format("{}.{}={}", frames_.back().path, key, word));
}

bool Walk::add(const toml::node& node, std::string_view key, const std::string& why, const std::string& mend) {
  if (faults_.size() >= most_faults) {
    ++left_out_;
    return false;
  }
  const std::string& table = frames_.back().name;
  const std::string name = table.empty() ? std::string(key) : fmt::format("{} {}", table, key);
  const std::string value = value_text(node);
  const std::string what =
      fmt::format("{}: {}{}", place(shown_, node.source()), name, value.empty() ? "" : " = " + value);
  faults_.push_back({node.source().begin, {what, why, mend}});
  return false;
}

std::string Walk::mend_for(const Unknown& unknown) const {
  if (!nearest(unknown.key, unknown.known).empty()) return did_you_mean(unknown.key, unknown.known);
  const auto elsewhere = all_known_.lower_bound({unknown.key, ""});
  if (elsewhere != all_known_.end() && elsewhere->first == unknown.key) return "It belongs in " + elsewhere->second;
  return did_you_mean(unknown.key, unknown.known);
}

void Walk::finish() {
  while (frames_.size() > 1) pop_table();
  for (const auto& unknown : unknown_) {
    const std::string at = place(shown_, unknown.source);
    const std::string_view advice = advice_on_gone(unknown.table_path + "." + unknown.key);
    if (!advice.empty()) {
      const std::string what = fmt::format("{}: {} {}: no longer a key", at, unknown.table_name, unknown.key);
      faults_.push_back({unknown.source.begin, {what, "", std::string(advice)}});
      continue;
    }
    const std::string what = fmt::format("{}: unknown key \"{}\" in {}", at, unknown.key, unknown.table_name);
    faults_.push_back({unknown.source.begin, {what, "", mend_for(unknown)}});
  }
  sort_and_hand_over();
}

void Walk::sort_and_hand_over() {
  std::stable_sort(faults_.begin(), faults_.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.at.line, a.at.column) < std::tie(b.at.line, b.at.column);
  });
  if (faults_.size() > most_faults) {
    left_out_ += faults_.size() - most_faults;
    faults_.erase(faults_.begin() + most_faults, faults_.end());
  }
  for (auto& placed : faults_) out_.push_back(std::move(placed.fault));
  if (left_out_ > 0)
    out_.push_back({fmt::format("{}: {} more faults", shown_, left_out_), "", "Mend those above first"});
}

}  // namespace talus::recipe
