// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recipes: one TOML file per scene with a table per stage. A stage's options are a plain struct whose
// describe(Visitor&) names every key once; the reader, the template and the used recipe are visitors of it.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "common/error.hpp"

namespace talus::recipe {

/// Allowed values; a bound is part of the range unless it is open.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool open_low = false;
  bool open_high = false;
};
inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr Range any{};
inline constexpr Range positive{0.0, infinity, true, false};
inline constexpr Range not_negative{0.0, infinity};
inline constexpr Range fraction{0.0, 1.0};

/// Rows of two numbers, [[a, b], ...].
using Pairs = std::vector<std::array<double, 2>>;

/// Walks the keys of a stage's options. A default is the value the member holds before the visit. Keys carry their unit
/// (density_kg_m3). `help` is one line, a comment of the template. A visitor overrides what it looks at.
class Visitor {
 public:
  virtual ~Visitor() = default;
  virtual void enter(std::string_view /*table*/, std::string_view /*help*/) {}  ///< open sub-table [..table]
  virtual void leave() {}
  virtual void number(std::string_view /*key*/, double& /*value*/, Range /*range*/, std::string_view /*help*/) {}
  virtual void optional_number(std::string_view /*key*/, std::optional<double>& /*value*/, Range /*range*/,
                               std::string_view /*help*/) {}
  virtual void integer(std::string_view /*key*/, int& /*value*/, Range /*range*/, std::string_view /*help*/) {}
  virtual void flag(std::string_view /*key*/, bool& /*value*/, std::string_view /*help*/) {}
  virtual void text(std::string_view /*key*/, std::string& /*value*/, std::string_view /*help*/) {}
  /// Relative paths in a recipe are relative to the recipe's folder; after reading they are absolute. Empty = not
  /// given.
  /// "${NAME}" inside is replaced by the environment variable NAME (an unset one is a fault). What chooses from a
  /// vector file (paths.hpp) stays as it is.
  virtual void path(std::string_view /*key*/, std::filesystem::path& /*value*/, std::string_view /*help*/) {}
  virtual void numbers(std::string_view /*key*/, std::vector<double>& /*value*/, Range /*range*/,
                       std::string_view /*help*/) {}
  virtual void integers(std::string_view /*key*/, std::vector<int>& /*value*/, Range /*range*/,
                        std::string_view /*help*/) {}
  /// One of `names`; index is its place in the list.
  virtual void one_of(std::string_view /*key*/, int& /*index*/, const std::vector<std::string_view>& /*names*/,
                      std::string_view /*help*/) {}
  /// Rows of two numbers.
  virtual void pairs(std::string_view /*key*/, Pairs& /*value*/, Range /*range*/, std::string_view /*help*/) {}
  /// A list of names out of `allowed`, or any where that is empty.
  virtual void names(std::string_view /*key*/, std::vector<std::string>& /*value*/,
                     const std::vector<std::string_view>& /*allowed*/, std::string_view /*help*/) {}
  /// Array of tables [[..key]]: begin_list says how many items there are (reader: in the file; writer: `size`).
  virtual std::size_t begin_list(std::string_view /*key*/, std::size_t size, std::string_view /*help*/) { return size; }
  virtual void begin_item(std::size_t /*item*/) {}
  virtual void end_item() {}
  virtual void end_list() {}
  /// What a value just described needs of other keys, declared beside it: `otherwise` is the fault where `met` is
  /// false. Only find_unmet() looks, at options read in full: the others may come later in the visit.
  virtual void needs(bool /*met*/, const Fault& /*otherwise*/) {}
};

/// An enum by name: choice(v, "shape", shape, {{"linear", Shape::linear}, {"quadratic", Shape::quadratic}}, "...").
template <class Enum>
void choice(Visitor& v, std::string_view key, Enum& value,
            std::initializer_list<std::pair<std::string_view, Enum>> names, std::string_view help) {
  std::vector<std::string_view> words;
  std::vector<Enum> values;
  int index = 0;
  for (const auto& [word, item] : names) {
    if (item == value) index = static_cast<int>(words.size());
    words.push_back(word);
    values.push_back(item);
  }
  v.one_of(key, index, words, help);
  value = values.at(static_cast<std::size_t>(index));
}

/// A list of the items `parts`. One of another length makes them NaN (the least integer), and is refused by `place`.
template <class T>
void fixed_list(Visitor& v, std::string_view key, const std::vector<T*>& parts, Range range, std::string_view help,
                const std::string& place) {
  using Limits = std::numeric_limits<T>;
  const T none = Limits::has_quiet_NaN ? Limits::quiet_NaN() : Limits::min();
  std::vector<T> values;
  for (const T* part : parts) values.push_back(*part);
  if constexpr (std::is_same_v<T, int>) {
    v.integers(key, values, range, help);
  } else {
    v.numbers(key, values, range, help);
  }
  const bool fits = values.size() == parts.size();
  for (std::size_t i = 0; i < parts.size(); ++i) *parts[i] = fits ? values[i] : none;
  const bool known = !std::isnan(static_cast<double>(*parts[0])) && *parts[0] != Limits::min();
  v.needs(known, {place + " " + std::string(key) + " is too long or too short",
                  "it has " + std::to_string(parts.size()) + " items: " + std::string(help), "Give as many"});
}

/// A sub-table [..key], whose keys options.describe(v, others...) declares with defaults, help and what they need of
/// one another; `others`: what needs() look at, or its name.
template <class T, class... Others>
void table(Visitor& v, std::string_view key, T& options, std::string_view help, const Others&... others) {
  v.enter(key, help);
  options.describe(v, others...);
  v.leave();
}

/// Items of an array of tables; describe(item, number) declares the keys of each, the number counted from 0.
template <class T, class Describe>
void list(Visitor& v, std::string_view key, std::vector<T>& items, std::string_view help, const Describe& describe) {
  const std::size_t count = v.begin_list(key, items.size(), help);
  items.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    v.begin_item(i);
    describe(items[i], i);
    v.end_item();
  }
  v.end_list();
}

/// Items that need nothing of others; T has describe(Visitor&).
template <class T>
void list(Visitor& v, std::string_view key, std::vector<T>& items, std::string_view help) {
  list(v, key, items, help, [&](T& item, std::size_t) { item.describe(v); });
}

/// The visitor that adds what the options need and do not have to `faults`.
std::unique_ptr<Visitor> make_checker(std::vector<Fault>& faults);

/// What the options need and do not have: the unmet needs() of their description, then the faults of check(), if any.
template <class Options>
void find_unmet(Options& options, std::vector<Fault>& faults) {
  options.describe(*make_checker(faults));
  if constexpr (requires { options.check(faults); }) options.check(faults);
}

/// A parsed recipe file. Throws RecipeError when the file is missing or is not TOML (with line and column).
class Recipe {
 public:
  /// `overrides` replace values of the file; the last of several wins. Each is "key=value", the key with all its tables
  /// and items of lists counted from 0 ("solve.material.density_kg_m3", "solve.part[0].release"), the value in TOML; a
  /// value that is not TOML and begins like no quoted text, list or table is text. Missing tables are made, missing
  /// items of lists are not. The values are checked like the file's; messages name "--set key=value".
  explicit Recipe(const std::filesystem::path& file, const std::vector<std::string>& overrides = {});
  /// The recipe in a text of TOML. Its paths are relative to `folder`; messages call it "recipe.toml".
  static Recipe parse(std::string_view text, const std::filesystem::path& folder = ".",
                      const std::vector<std::string>& overrides = {});
  Recipe(Recipe&& other) noexcept;
  ~Recipe();
  /// The recipe with other values, "key=value" each as above. Throws RecipeError: what cannot be put in.
  Recipe with(const std::vector<std::string>& values) const;
  const std::vector<std::string>& overrides() const;  ///< the overrides of the constructor, as they were given
  const std::filesystem::path& file() const;
  std::string scene_name() const;  ///< [scene] name, or the file's stem
  std::string title() const;       ///< [scene] title, or the name

  /// A table, or a value ("solve.base.law"), as the recipe writes it (defaults not filled in, variables not replaced),
  /// in an order and a spelling that do not depend on the file's: recipes of the same text say the same. None: no such.
  std::optional<std::string> canonical(std::string_view table) const;

  /// Read table `stage` into options. All faults at once: unknown keys (with "did you mean"), wrong types, values out
  /// of range, each with line and column; then what find_unmet() adds. Throws RecipeError if there is any.
  /// A top-level table other than scene, preprocess, solve, postprocess, ensemble, slides and fit is unknown.
  template <class Options>
  Options read(std::string_view stage) const {
    Options options;
    std::vector<Fault> faults;
    options.describe(*make_reader(stage, faults));  // whose end reports the keys nobody asked for
    if (faults.empty()) find_unmet(options, faults);
    if (!faults.empty()) throw RecipeError(std::move(faults));
    return options;
  }

 private:
  std::unique_ptr<Visitor> make_reader(std::string_view stage, std::vector<Fault>& faults) const;
  struct Parsed;
  explicit Recipe(std::unique_ptr<Parsed> parsed);
  static std::unique_ptr<Parsed> parsed(std::string_view text, const std::filesystem::path& file, std::string shown,
                                        const std::vector<std::string>& overrides);
  std::unique_ptr<Parsed> parsed_;
};

/// The options as TOML under [stage]; with_help adds each key's line of help and its range as a comment.
std::unique_ptr<Visitor> make_writer(std::string_view stage, bool with_help, std::string& text);

template <class Options>
std::string to_toml(Options options, std::string_view stage, bool with_help) {
  std::string text;
  options.describe(*make_writer(stage, with_help, text));  // whose end writes
  return text;
}

/// Values as TOML by their place, "solve.material.friction_angle_deg"; items of a list share one place.
using Defaults = std::map<std::string, std::string>;

/// Collects the values of the options visited; of an empty list, those of a new item.
std::unique_ptr<Visitor> make_collector(std::string_view stage, Defaults& values);

/// As make_writer without help, but a value that is not that of `defaults` is followed by "# default: X" (an optional
/// number that has no default: "# default: none"). `defaults` must outlive the visitor.
std::unique_ptr<Visitor> make_marking_writer(std::string_view stage, const Defaults& defaults, std::string& text);

/// The options as they were used, for write_used_recipe(): what was changed from its default is marked.
template <class Options>
std::string to_used_toml(Options options, std::string_view stage) {
  Defaults defaults;
  Options fresh;
  fresh.describe(*make_collector(stage, defaults));
  std::string text;
  options.describe(*make_marking_writer(stage, defaults, text));
  return text;
}

/// What messages put in front of "key=value" in the place of file, line and column.
inline constexpr std::string_view set_mark = "--set ";

/// Shortest TOML float that reads back to the same double: 5 -> "5.0".
std::string toml_number(double value);

/// A TOML basic string with its quotes.
std::string toml_text(std::string_view text);

/// "> 0", "0 to 1", ">= 0 and < 90"; "" for any.
std::string range_text(const Range& range);

bool inside(const Range& range, double value);

/// "\"linear\" or \"quadratic\""
std::string names_text(const std::vector<std::string_view>& names);

}  // namespace talus::recipe
