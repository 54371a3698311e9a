// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A recipe file as toml++ holds it, and the way through its tables. Only the recipe's own .cpp files see this header.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "common/recipe/toml.hpp"

namespace talus::recipe {

struct Recipe::Parsed {
  std::filesystem::path file;          ///< absolute
  std::string shown;                   ///< as the user wrote it, for messages
  std::vector<std::string> overrides;  ///< the values of the constructor, as they were given
  toml::table root;
};

/// The tables a recipe may hold.
inline constexpr std::string_view known_tables[] = {"scene",    "preprocess", "solve", "postprocess",
                                                    "ensemble", "slides",     "fit",   "calibrate"};

/// "recipe.toml:12:3", or "--set key=value" where the value was given so
std::string place(const std::string& file, const toml::source_region& source);

/// Where character `column` of a line (from 1, as toml++ counts: code points) begins.
std::size_t byte_of(std::string_view line, std::size_t column);

/// Puts the values of a recipe's constructor into a parsed recipe. Throws RecipeError: what cannot be put in.
void apply_overrides(toml::table& root, const std::vector<std::string>& overrides);

/// Reads `stage` from `root`; the faults, in the order of the file, are added to `faults` when it ends.
std::unique_ptr<Visitor> make_table_reader(const toml::table& root, std::string shown, std::filesystem::path folder,
                                           std::string_view stage, std::vector<Fault>& faults);

class Walk {
 public:
  Walk(const toml::table& root, std::string shown, std::vector<Fault>& faults);

  void push_table(std::string_view key);
  void push_item(std::size_t item);  ///< of the innermost list
  void pop_table();                  ///< notes the keys that nobody asked for

  /// Length of list `key`, or `size` where the file has none.
  std::size_t push_list(std::string_view key, std::size_t size);
  void pop_list() { lists_.pop_back(); }

  /// The value of a key in the table at hand, or null; from now on the key is known.
  const toml::node* find(std::string_view key);

  /// The advice on a word that a choice in the table at hand had in earlier versions; empty: it never had.
  std::string_view advice_on_word(std::string_view key, std::string_view word) const;

  /// A fault at a value: "recipe.toml:3:8: [solve] steps = 0 (why). mend". Returns false.
  bool add(const toml::node& node, std::string_view key, const std::string& why, const std::string& mend);

  void finish();  ///< leave all tables and hand the faults over, in the order of the file

 private:
  /// A table on the way down. `table` is null where the file has none: then every key keeps its default.
  struct Frame {
    const toml::table* table = nullptr;
    std::string name{};                // "[solve.material]"
    std::string path{};                // "solve.material"
    std::vector<std::string> known{};  // keys asked for so far
  };
  /// `items` is null where the file has no such list.
  struct List {
    const toml::array* items = nullptr;
    std::string path;
  };
  struct Placed {
    toml::source_position at;
    Fault fault;
  };
  struct Unknown {
    std::string key, table_name, table_path;
    toml::source_region source;
    std::vector<std::string> known;
  };

  std::string mend_for(const Unknown& unknown) const;
  void sort_and_hand_over();

  std::string shown_;
  std::vector<Fault>& out_;
  std::vector<Placed> faults_;
  std::vector<Unknown> unknown_;
  std::size_t left_out_ = 0;  // faults beyond the first of either list
  std::vector<Frame> frames_;
  std::vector<List> lists_;
  std::set<std::pair<std::string, std::string>> all_known_;  // (key, table name): "it belongs in ..."
};

/// A value as a recipe writes it: "5", "\"linear\""; empty for lists, tables and dates.
std::string value_text(const toml::node& node);

/// "text", "an integer", "a table", ...
std::string kind_of(const toml::node& node);

}  // namespace talus::recipe
