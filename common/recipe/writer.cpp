// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The visitor that writes options as TOML. TOML wants a table's keys before its sub-tables, whatever the order of the
// visit, so a tree is built first and written at the end.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/recipe/recipe.hpp"

namespace talus::recipe {
namespace {

struct Table {
  std::string path;
  std::string help;
  bool item = false;     // [[path]]
  bool example = false;  // commented out: shows the keys of a list that is empty by default
  std::string keys{};
  std::vector<std::unique_ptr<Table>> children{};
};

/// What is written beside the plain values.
struct Extras {
  bool help = false;
  const Defaults* defaults = nullptr;  // mark what differs from these
  Defaults* collected = nullptr;       // put the values here as well
};

/// "[1.0, 2.0]", each item as `text` has it.
template <class Items, class Text>
std::string list_of(const Items& items, const Text& text) {
  std::vector<std::string> words;
  for (const auto& item : items) words.push_back(text(item));
  return fmt::format("[{}]", fmt::join(words, ", "));
}

class Writer : public Visitor {
 public:
  /// Without a `text` nobody reads it.
  Writer(std::string_view stage, const Extras& extras, std::string* text)
      : extras_(extras), out_(text != nullptr ? *text : unread_) {
    root_.path = stage;
    open_.push_back(&root_);
  }
  Writer(const Writer&) = delete;
  Writer& operator=(const Writer&) = delete;
  ~Writer() override { write(root_); }

  void enter(std::string_view table, std::string_view help) override { open(table, help, false); }
  void leave() override { open_.pop_back(); }

  void number(std::string_view key, double& value, Range range, std::string_view help) override {
    line(key, toml_number(value), help, range_text(range));
  }
  void optional_number(std::string_view key, std::optional<double>& value, Range range,
                       std::string_view help) override {
    if (value)
      line(key, toml_number(*value), help, range_text(range));
    else if (extras_.help)
      line(fmt::format("# {}", key), "...", help, range_text(range));
  }
  void integer(std::string_view key, int& value, Range range, std::string_view help) override {
    line(key, fmt::format("{}", value), help, range_text(range));
  }
  void flag(std::string_view key, bool& value, std::string_view help) override {
    line(key, value ? "true" : "false", help, "");
  }
  void text(std::string_view key, std::string& value, std::string_view help) override {
    line(key, toml_text(value), help, "");
  }
  void path(std::string_view key, std::filesystem::path& value, std::string_view help) override {
    line(key, toml_text(value.generic_string()), help, "");
  }
  void numbers(std::string_view key, std::vector<double>& value, Range range, std::string_view help) override {
    line(key, list_of(value, toml_number), help, range_text(range));
  }
  void pairs(std::string_view key, Pairs& value, Range range, std::string_view help) override {
    const auto row = [](const auto& pair) { return list_of(pair, toml_number); };
    line(key, list_of(value, row), help, range_text(range));
  }
  void integers(std::string_view key, std::vector<int>& value, Range range, std::string_view help) override {
    line(key, fmt::format("[{}]", fmt::join(value, ", ")), help, range_text(range));
  }
  void one_of(std::string_view key, int& index, const std::vector<std::string_view>& names,
              std::string_view help) override {
    line(key, toml_text(names.at(static_cast<std::size_t>(index))), help, names_text(names));
  }
  void names(std::string_view key, std::vector<std::string>& value, const std::vector<std::string_view>& allowed,
             std::string_view help) override {
    line(key, list_of(value, toml_text), help, names_text(allowed));
  }
  std::size_t begin_list(std::string_view key, std::size_t size, std::string_view help) override {
    lists_.push_back({std::string(key), std::string(help), size == 0});
    return size == 0 && (extras_.help || extras_.collected != nullptr) ? 1 : size;
  }
  void begin_item(std::size_t item) override {
    const List& list = lists_.back();
    open(list.key, item == 0 ? list.help : "", true);
    open_.back()->example = open_.back()->example || list.example;
  }
  void end_item() override { open_.pop_back(); }
  void end_list() override { lists_.pop_back(); }

 private:
  struct List {
    std::string key, help;
    bool example;
  };

  void open(std::string_view key, std::string_view help, bool item) {
    Table& parent = *open_.back();
    const std::string path = parent.path + "." + std::string(key);
    parent.children.push_back(std::make_unique<Table>(Table{path, std::string(help), item, parent.example}));
    open_.push_back(parent.children.back().get());
  }

  void line(std::string_view key, const std::string& value, std::string_view help, const std::string& range) {
    Table& table = *open_.back();
    const char* mark = table.example ? "# " : "";
    if (extras_.help)
      table.keys += fmt::format("{}# {}{}\n", mark, help, range.empty() ? "" : fmt::format(" [{}]", range));
    table.keys += fmt::format("{}{} = {}{}\n", mark, key, value, default_mark(table, key, value));
  }

  /// "  # default: 25.0" behind a value that is another; collects it where that is wanted.
  std::string default_mark(const Table& table, std::string_view key, const std::string& value) {
    const auto place = fmt::format("{}.{}", table.path, key);
    if (extras_.collected != nullptr) (*extras_.collected)[place] = value;
    if (extras_.defaults == nullptr) return "";
    const auto usual = extras_.defaults->find(place);
    if (usual != extras_.defaults->end() && usual->second == value) return "";
    return "  # default: " + (usual == extras_.defaults->end() ? "none" : usual->second);
  }

  void write(const Table& table) {
    if (!out_.empty() && !out_.ends_with("\n\n")) out_ += '\n';
    if (extras_.help && !table.help.empty()) out_ += fmt::format("{}# {}\n", table.example ? "# " : "", table.help);
    out_ += fmt::format("{}{}{}{}\n", table.example ? "# " : "", table.item ? "[[" : "[", table.path,
                        table.item ? "]]" : "]");
    out_ += table.keys;
    for (const auto& child : table.children) write(*child);
  }

  Extras extras_;
  std::string unread_;
  std::string& out_;
  Table root_;
  std::vector<Table*> open_;
  std::vector<List> lists_;
};

}  // namespace

std::unique_ptr<Visitor> make_writer(std::string_view stage, bool with_help, std::string& text) {
  return std::make_unique<Writer>(stage, Extras{.help = with_help}, &text);
}

std::unique_ptr<Visitor> make_marking_writer(std::string_view stage, const Defaults& defaults, std::string& text) {
  return std::make_unique<Writer>(stage, Extras{.defaults = &defaults}, &text);
}

std::unique_ptr<Visitor> make_collector(std::string_view stage, Defaults& values) {
  return std::make_unique<Writer>(stage, Extras{.collected = &values}, nullptr);
}

}  // namespace talus::recipe
