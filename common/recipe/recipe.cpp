// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/recipe/recipe.hpp"

#include <algorithm>
#include <cctype>
#include <sstream>

#include <fmt/format.h>

#include "common/recipe/gone_keys.hpp"
#include "common/recipe/parsed.hpp"
#include "common/recipe/paths.hpp"
#include "common/recipe/suggest.hpp"
#include "common/text_encoding.hpp"
#include "common/whole_text.hpp"

namespace talus::recipe {
namespace fs = std::filesystem;

std::string toml_number(double value) {
  std::string text = fmt::format("{}", value);
  if (std::isfinite(value) && text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_text(std::string_view text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    const auto code = static_cast<unsigned char>(c);
    if (code < 0x20 || code == 0x7f)
      result += fmt::format("\\u{:04x}", code);
    else
      result += c;
  }
  return result + '"';
}

std::string range_text(const Range& range) {
  const bool low = std::isfinite(range.low);
  const bool high = std::isfinite(range.high);
  if (low && high && !range.open_low && !range.open_high) return fmt::format("{} to {}", range.low, range.high);
  std::string text;
  if (low) text += fmt::format("{} {}", range.open_low ? ">" : ">=", range.low);
  if (low && high) text += " and ";
  if (high) text += fmt::format("{} {}", range.open_high ? "<" : "<=", range.high);
  return text;
}

bool inside(const Range& range, double value) {
  const bool above = range.open_low ? value > range.low : value >= range.low;
  const bool below = range.open_high ? value < range.high : value <= range.high;
  return above && below;
}

std::string names_text(const std::vector<std::string_view>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " or " : ", ";
    text += fmt::format("\"{}\"", names[i]);
  }
  return text;
}

namespace {

std::string contents_of(const fs::path& file) {
  constexpr std::uintmax_t most = 16 << 20;  // far beyond any recipe
  return whole_text(file, most, [&](const std::string& reason) {
    throw RecipeError(Fault{file.string() + ": the recipe cannot be read", reason, "Check the path"});
  });
}

toml::table toml_of(std::string_view text, const std::string& shown) {
  try {
    return toml::parse(text, shown);
  } catch (const toml::parse_error& error) {
    const std::string_view wide = wide_encoding(text), encoding = wide.empty() && !is_utf8(text) ? "CP1252" : wide;
    if (!encoding.empty())
      throw RecipeError(Fault{place(shown, error.source()) + ": the recipe is not UTF-8",
                              wide.empty() ? "it may be CP1252 (Western European)" : fmt::format("it is {}", wide),
                              mend_of_encoding(encoding, shown)});
    const bool escape = error.description().find("escape") != std::string_view::npos;
    throw RecipeError(Fault{place(shown, error.source()) + ": this is not TOML", std::string(error.description()),
                            escape ? "A backslash in double quotes begins an escape: write / in paths, or single quotes"
                                   : "Mend the line; the format is described on https://toml.io"});
  }
}

/// [scene] has a name and a title; the name becomes part of file names.
struct Scene {
  std::string name, title;
  void describe(Visitor& v) {
    v.text("name", name, "short name, part of file names");
    v.text("title", title, "what the map is called");
  }
};

Scene scene_of(const toml::table& root) {
  return {root["scene"]["name"].value_or(std::string{}), root["scene"]["title"].value_or(std::string{})};
}

bool fit_for_a_file_name(const std::string& name) {
  return std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return std::isalnum(c) || c == '-' || c == '_' || c == '.'; });
}

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

std::string place(const std::string& file, const toml::source_region& source) {
  if (source.path && source.path->starts_with(set_mark)) return *source.path;
  return fmt::format("{}:{}:{}", file, source.begin.line, source.begin.column);
}

std::unique_ptr<Recipe::Parsed> Recipe::parsed(std::string_view text, const fs::path& file, std::string shown,
                                               const std::vector<std::string>& overrides) {
  auto parsed = std::make_unique<Parsed>();
  parsed->root = toml_of(text, shown);
  parsed->overrides = overrides;
  apply_overrides(parsed->root, overrides);
  parsed->file = fs::absolute(file).lexically_normal();
  parsed->shown = std::move(shown);
  return parsed;
}

Recipe::Recipe(const fs::path& file, const std::vector<std::string>& overrides)
    : parsed_(parsed(contents_of(file), file, file.string(), overrides)) {
  refuse_name_beyond_utf8(parsed_->file);
  show_path_as(parsed_->file, parsed_->shown, file.filename().string());
  show_path_as(parsed_->file.parent_path(), file.parent_path().string(), "");
}

Recipe Recipe::parse(std::string_view text, const fs::path& folder, const std::vector<std::string>& overrides) {
  return Recipe(parsed(text, folder / "recipe.toml", "recipe.toml", overrides));
}

Recipe::Recipe(std::unique_ptr<Parsed> parsed) : parsed_(std::move(parsed)) {}
Recipe::Recipe(Recipe&& other) noexcept = default;
Recipe::~Recipe() = default;

Recipe Recipe::with(const std::vector<std::string>& values) const {
  auto changed = std::make_unique<Parsed>(*parsed_);
  apply_overrides(changed->root, values);
  return Recipe(std::move(changed));
}

const fs::path& Recipe::file() const { return parsed_->file; }

const std::vector<std::string>& Recipe::overrides() const { return parsed_->overrides; }

std::string Recipe::scene_name() const {
  std::string name = scene_of(parsed_->root).name;
  if (!name.empty()) return name;
  std::string stem = parsed_->file.stem().string();
  for (char& c : stem)
    if (!fit_for_a_file_name(std::string(1, c))) c = '_';
  return stem;
}

std::string Recipe::title() const {
  std::string title = scene_of(parsed_->root).title;
  return title.empty() ? scene_name() : title;
}

std::unique_ptr<Visitor> Recipe::make_reader(std::string_view stage, std::vector<Fault>& faults) const {
  const std::vector<std::string> tables(std::begin(known_tables), std::end(known_tables));
  for (const auto& [key, node] : parsed_->root) {
    if (std::find(tables.begin(), tables.end(), key.str()) != tables.end()) continue;
    const std::string kind = node.is_table() ? "table" : "key", at = place(parsed_->shown, key.source());
    if (const std::string_view advice = advice_on_gone(key.str()); !advice.empty()) {
      faults.push_back({fmt::format("{}: [{}]: no longer a table", at, key.str()), "", std::string(advice)});
      continue;
    }
    faults.push_back(
        {fmt::format("{}: unknown top-level {} \"{}\"", at, kind, key.str()), "", did_you_mean(key.str(), tables)});
  }
  const fs::path folder = parsed_->file.parent_path();
  Scene scene;
  scene.describe(*make_table_reader(parsed_->root, parsed_->shown, folder, "scene", faults));
  if (!fit_for_a_file_name(scene.name))
    faults.push_back({fmt::format("{}: [scene] name = \"{}\"",
                                  place(parsed_->shown, parsed_->root["scene"]["name"].node()->source()), scene.name),
                      "it becomes part of file names",
                      "Use letters, digits, '-', '_' and '.' only; put the rest into title"});
  return make_table_reader(parsed_->root, parsed_->shown, folder, stage, faults);
}

std::optional<std::string> Recipe::canonical(std::string_view place) const {
  const auto found = toml::at_path(parsed_->root, place);
  if (!found) return std::nullopt;
  std::string text;
  append(*found.node(), text);
  return text;
}

}  // namespace talus::recipe
