// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The visitor that fills options from a parsed table and notes every fault on the way.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "common/recipe/dataset_name.hpp"
#include "common/recipe/parsed.hpp"
#include "common/recipe/paths.hpp"
#include "common/recipe/recipe.hpp"
#include "common/recipe/suggest.hpp"

namespace talus::recipe {
namespace fs = std::filesystem;
namespace {

/// "${NAME}" by the environment; names that are unset go into `unset`.
std::string expand(const std::string& text, std::vector<std::string>& unset) {
  std::string result;
  std::size_t at = 0;
  for (std::size_t open; (open = text.find("${", at)) != std::string::npos;) {
    const std::size_t close = text.find('}', open);
    if (close == std::string::npos) break;
    const std::string name = text.substr(open + 2, close - open - 2);
    const char* found = std::getenv(name.c_str());
    if (found == nullptr) unset.push_back(name);
    result += text.substr(at, open - at) + (found == nullptr ? "" : found);
    at = close + 1;
  }
  return result + text.substr(at);
}

/// What GDAL fetches (PG:dbname=x, /vsicurl/...) is no path, nor has it one of this machine in it.
bool names_no_file(const std::string& text) {
  const std::size_t colon = text.find(':');
  return text.starts_with("/vsi") ||
         (colon != std::string::npos && colon > 1 &&
          std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                      [](unsigned char c) { return std::isupper(c) || std::isdigit(c) || c == '_'; }));
}

class Reader : public Visitor {
 public:
  Reader(const toml::table& root, std::string shown, fs::path folder, std::string_view stage,
         std::vector<Fault>& faults)
      : walk_(root, shown, faults), folder_(std::move(folder)), shown_(std::move(shown)) {
    walk_.push_table(stage);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() override { walk_.finish(); }

  void enter(std::string_view table, std::string_view) override { walk_.push_table(table); }
  void leave() override { walk_.pop_table(); }

  void number(std::string_view key, double& value, Range range, std::string_view) override {
    if (const auto* node = walk_.find(key)) read_number(*node, key, value, range, std::isfinite(value));
  }
  void optional_number(std::string_view key, std::optional<double>& value, Range range, std::string_view) override {
    const auto* node = walk_.find(key);
    double read = 0;
    if (node != nullptr && read_number(*node, key, read, range, true)) value = read;
  }
  void integer(std::string_view key, int& value, Range range, std::string_view) override {
    if (const auto* node = walk_.find(key)) read_integer(*node, key, value, range);
  }
  void flag(std::string_view key, bool& value, std::string_view) override {
    if (const auto* node = walk_.find(key)) read_plain(*node, key, value, "true or false");
  }
  void text(std::string_view key, std::string& value, std::string_view) override {
    if (const auto* node = walk_.find(key)) read_plain(*node, key, value, "text in quotes");
  }
  void path(std::string_view key, fs::path& value, std::string_view) override {
    const auto* node = walk_.find(key);
    std::string text = value.string();
    if (node != nullptr && !read_plain(*node, key, text, "a path in quotes")) return;
    if (node != nullptr && std::ranges::any_of(text, [](char c) { return static_cast<unsigned char>(c) < ' '; })) {
      walk_.add(*node, key, fmt::format("{} holds a control character", toml_text(text)),
                "A backslash in double quotes begins an escape (\\b, \\t, \\n): write / in paths, or single quotes");
      return;
    }
    VectorSource source = vector_source(text);
    const std::string given = source.file.string();
    std::vector<std::string> unset;
    const std::string expanded = expand(given, unset);
    for (const auto& name : unset) {
      if (node == nullptr) break;
      walk_.add(*node, key, fmt::format("the environment variable {} is not set", name),
                fmt::format("Set it: export {}=...", name));
    }
    if (!unset.empty()) return;
    const auto inside = dataset_name(expanded, folder_);
    const bool as_it_is = expanded.empty() || (!inside && names_no_file(expanded));
    source.file = as_it_is ? fs::path(expanded)
                  : inside ? fs::path(inside->from(folder_))
                           : (folder_ / expanded).lexically_normal();
    value = source.text();
    const std::string path = inside ? inside->path : given;
    if (as_it_is || fs::path(path).is_absolute()) return;
    const bool by_environment = given != expanded;
    if (inside && by_environment) return;
    const fs::path from_here = fs::path(shown_).parent_path() / path, file = inside ? folder_ / path : source.file;
    show_path_as(file, by_environment ? given : from_here.lexically_normal().string(), path);
  }
  void numbers(std::string_view key, std::vector<double>& value, Range range, std::string_view) override {
    read_list(key, value, [&](const toml::node& node, const std::string& name, double& item) {
      return read_number(node, name, item, range, true);
    });
  }
  void integers(std::string_view key, std::vector<int>& value, Range range, std::string_view) override {
    read_list(key, value, [&](const toml::node& node, const std::string& name, int& item) {
      return read_integer(node, name, item, range);
    });
  }
  void pairs(std::string_view key, Pairs& value, Range range, std::string_view) override {
    read_list(key, value, [&](const toml::node& node, const std::string& name, std::array<double, 2>& row) {
      const auto* pair = node.as_array();
      if (pair == nullptr || pair->size() != 2)
        return walk_.add(node, name, "a row of two numbers is wanted", fmt::format("Write {} = [[a, b], ...]", key));
      return read_number(*pair->get(0), name + "[0]", row[0], range, true) &&
             read_number(*pair->get(1), name + "[1]", row[1], range, true);
    });
  }
  void one_of(std::string_view key, int& index, const std::vector<std::string_view>& names, std::string_view) override {
    const auto* node = walk_.find(key);
    std::string word;
    if (node == nullptr || !read_plain(*node, key, word, names_text(names).c_str())) return;
    if (is_one_of(*node, key, word, names))
      index = static_cast<int>(std::find(names.begin(), names.end(), word) - names.begin());
  }
  void names(std::string_view key, std::vector<std::string>& value, const std::vector<std::string_view>& allowed,
             std::string_view) override {
    read_list(key, value, [&](const toml::node& node, const std::string& name, std::string& item) {
      if (allowed.empty()) return read_plain(node, name, item, "text in quotes");
      return read_plain(node, name, item, names_text(allowed).c_str()) && is_one_of(node, name, item, allowed);
    });
  }
  std::size_t begin_list(std::string_view key, std::size_t size, std::string_view) override {
    return walk_.push_list(key, size);
  }
  void begin_item(std::size_t item) override { walk_.push_item(item); }
  void end_item() override { walk_.pop_table(); }
  void end_list() override { walk_.pop_list(); }

 private:
  template <class T>
  bool read_plain(const toml::node& node, std::string_view key, T& value, const char* wanted) {
    if (const auto exact = node.value_exact<T>()) {
      value = *exact;
      return true;
    }
    return walk_.add(node, key, fmt::format("it is {}", kind_of(node)), fmt::format("Give {}", wanted));
  }

  bool is_one_of(const toml::node& node, std::string_view key, const std::string& word,
                 const std::vector<std::string_view>& names) {
    if (std::find(names.begin(), names.end(), word) != names.end()) return true;
    if (const std::string_view advice = walk_.advice_on_word(key.substr(0, key.find('[')), word); !advice.empty())
      return walk_.add(node, key, "no longer a choice", std::string(advice));
    const std::string near = nearest(word, {names.begin(), names.end()});
    return walk_.add(
        node, key, "no such choice",
        (near.empty() ? "" : fmt::format("Did you mean \"{}\"? ", near)) + "It must be " + names_text(names));
  }

  bool in_range(const toml::node& node, std::string_view key, double value, const Range& range) {
    return inside(range, value) || walk_.add(node, key, "out of range", "It must be " + range_text(range));
  }

  bool read_number(const toml::node& node, std::string_view key, double& value, const Range& range, bool finite) {
    if (!node.is_number()) return walk_.add(node, key, fmt::format("it is {}", kind_of(node)), "Give a number");
    const double read =
        node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
    if (std::isnan(read) || (finite && !std::isfinite(read)))
      return walk_.add(node, key, "it is not a finite number",
                       "Give a number" + (range_text(range).empty() ? "" : " " + range_text(range)));
    if (!in_range(node, key, read, range)) return false;
    value = read;
    return true;
  }

  bool read_integer(const toml::node& node, std::string_view key, int& value, const Range& range) {
    const auto* integer = node.as_integer();
    if (integer == nullptr)
      return walk_.add(node, key, fmt::format("it is {}", kind_of(node)), "Give an integer, without a decimal point");
    const auto read = integer->get();
    if (!in_range(node, key, static_cast<double>(read), range)) return false;
    if (read != static_cast<int>(read))
      return walk_.add(
          node, key, "out of range",
          fmt::format("It must be {} to {}", std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
    value = static_cast<int>(read);
    return true;
  }

  template <class T, class ReadItem>
  void read_list(std::string_view key, std::vector<T>& value, ReadItem&& read_item) {
    const auto* node = walk_.find(key);
    if (node == nullptr) return;
    const auto* array = node->as_array();
    if (array == nullptr) {
      walk_.add(*node, key, "a list is wanted", fmt::format("Write {} = [...]", key));
      return;
    }
    std::vector<T> read(array->size());
    bool good = true;
    for (std::size_t i = 0; i < read.size(); ++i)
      good = read_item(*array->get(i), fmt::format("{}[{}]", key, i), read[i]) && good;
    if (good) value = std::move(read);
  }

  Walk walk_;
  fs::path folder_;
  std::string shown_;  // the recipe as the user wrote it
};

class Checker : public Visitor {
 public:
  explicit Checker(std::vector<Fault>& faults) : faults_(faults) {}
  void needs(bool met, const Fault& otherwise) override {
    if (!met) faults_.push_back(otherwise);
  }

 private:
  std::vector<Fault>& faults_;
};

}  // namespace

std::unique_ptr<Visitor> make_table_reader(const toml::table& root, std::string shown, fs::path folder,
                                           std::string_view stage, std::vector<Fault>& faults) {
  return std::make_unique<Reader>(root, std::move(shown), std::move(folder), stage, faults);
}

std::unique_ptr<Visitor> make_checker(std::vector<Fault>& faults) { return std::make_unique<Checker>(faults); }

}  // namespace talus::recipe
