// The visitor that fills options from a parsed table and notes every fault on the way.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <tuple>

#include "common/recipe/parsed.hpp"
#include "common/recipe/suggest.hpp"
#include "common/recipe/values.hpp"

namespace talus::recipe {
namespace fs = std::filesystem;
namespace {

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

/// " = 5"; nothing for what would not fit on a line.
std::string value_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return " = " + toml_text(text->get());
  if (const auto* number = node.as_floating_point()) return " = " + toml_number(number->get());
  if (const auto* integer = node.as_integer()) return fmt::format(" = {}", integer->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? " = true" : " = false";
  return "";
}

/// A table on the way down. `table` is null where the file has none: then every key keeps its default.
struct Frame {
  const toml::table* table = nullptr;
  std::string name;                  // "[solve.material]"
  std::string path;                  // "solve.material"
  std::vector<std::string> known{};  // keys asked for so far
};

/// A list being read. `items` is null where the file has none.
struct List {
  const toml::array* items = nullptr;
  std::string path;
};

class Reader : public Visitor {
 public:
  Reader(const toml::table& root, std::string shown, fs::path folder, std::string_view stage,
         std::vector<Fault>& faults)
      : shown_(std::move(shown)), folder_(std::move(folder)), stage_(stage), out_(faults) {
    frames_.push_back({nullptr, "", ""});
    frames_.back().table = &root;
    push_table(stage);
  }
  Reader(const Reader&) = delete;
  Reader& operator=(const Reader&) = delete;
  ~Reader() override { finish(); }

  void enter(std::string_view table, std::string_view) override { push_table(table); }
  void leave() override { pop_table(); }

  void number(std::string_view key, double& value, Range range, std::string_view) override {
    if (const auto* node = find(key)) read_number(*node, key, value, range, std::isfinite(value));
  }
  void optional_number(std::string_view key, std::optional<double>& value, Range range, std::string_view) override {
    const auto* node = find(key);
    double read = 0;
    if (node != nullptr && read_number(*node, key, read, range, true)) value = read;
  }
  void integer(std::string_view key, int& value, Range range, std::string_view) override {
    if (const auto* node = find(key)) read_integer(*node, key, value, range);
  }
  void flag(std::string_view key, bool& value, std::string_view) override {
    if (const auto* node = find(key)) read_plain(*node, key, value, "true or false");
  }
  void text(std::string_view key, std::string& value, std::string_view) override {
    if (const auto* node = find(key)) read_plain(*node, key, value, "text in quotes");
  }
  void path(std::string_view key, fs::path& value, std::string_view) override;
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
  void one_of(std::string_view key, int& index, const std::vector<std::string_view>& names, std::string_view) override;
  std::size_t begin_list(std::string_view key, std::size_t size, std::string_view) override;
  void begin_item(std::size_t item) override;
  void end_item() override { pop_table(); }
  void end_list() override { lists_.pop_back(); }

 private:
  struct Placed {
    toml::source_position at;
    Fault fault;
  };
  struct Unknown {
    std::string key, table_name;
    toml::source_region source;
    std::vector<std::string> known;
  };

  const toml::node* find(std::string_view key) {
    Frame& frame = frames_.back();
    if (std::find(frame.known.begin(), frame.known.end(), key) == frame.known.end()) frame.known.emplace_back(key);
    return frame.table == nullptr ? nullptr : frame.table->get(key);
  }

  void add(const toml::node& node, std::string_view key, const std::string& why, const std::string& mend) {
    const std::string& table = frames_.back().name;
    const std::string name = table.empty() ? std::string(key) : fmt::format("{} {}", table, key);
    faults_.push_back({node.source().begin,
                       {fmt::format("{}: {}{}", place(shown_, node.source()), name, value_text(node)), why, mend}});
  }

  template <class T>
  bool read_plain(const toml::node& node, std::string_view key, T& value, const char* wanted) {
    if (const auto exact = node.value_exact<T>()) {
      value = *exact;
      return true;
    }
    add(node, key, fmt::format("it is {}", kind_of(node)), fmt::format("Give {}", wanted));
    return false;
  }

  bool in_range(const toml::node& node, std::string_view key, double value, const Range& range) {
    if (inside(range, value)) return true;
    add(node, key, "out of range", "It must be " + range_text(range));
    return false;
  }

  bool read_number(const toml::node& node, std::string_view key, double& value, const Range& range, bool finite);
  bool read_integer(const toml::node& node, std::string_view key, int& value, const Range& range);
  template <class T, class ReadItem>
  void read_list(std::string_view key, std::vector<T>& value, ReadItem&& read_item);

  void push_table(std::string_view key);
  void pop_table();
  void finish();
  std::string mend_for(const Unknown& unknown) const;

  std::string shown_;
  fs::path folder_;
  std::string stage_;
  std::vector<Fault>& out_;
  std::vector<Placed> faults_;
  std::vector<Unknown> unknown_;
  std::vector<Frame> frames_;
  std::vector<List> lists_;
  std::set<std::pair<std::string, std::string>> all_known_;  // (key, table name): "it belongs in ..."
};

void Reader::push_table(std::string_view key) {
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

void Reader::pop_table() {
  const Frame& frame = frames_.back();
  for (const auto& key : frame.known) all_known_.emplace(key, frame.name);
  if (frame.table != nullptr) {
    for (const auto& [key, node] : *frame.table)
      if (std::find(frame.known.begin(), frame.known.end(), key.str()) == frame.known.end())
        unknown_.push_back({std::string(key.str()), frame.name, key.source(), frame.known});
  }
  frames_.pop_back();
}

std::string Reader::mend_for(const Unknown& unknown) const {
  if (!nearest(unknown.key, unknown.known).empty()) return did_you_mean(unknown.key, unknown.known);
  const auto elsewhere = all_known_.lower_bound({unknown.key, ""});
  if (elsewhere != all_known_.end() && elsewhere->first == unknown.key) return "It belongs in " + elsewhere->second;
  return did_you_mean(unknown.key, unknown.known);
}

void Reader::finish() {
  while (frames_.size() > 1) pop_table();
  for (const auto& unknown : unknown_)
    faults_.push_back(
        {unknown.source.begin,
         {fmt::format("{}: unknown key \"{}\" in {}", place(shown_, unknown.source), unknown.key, unknown.table_name),
          "", mend_for(unknown)}});
  std::stable_sort(faults_.begin(), faults_.end(), [](const Placed& a, const Placed& b) {
    return std::tie(a.at.line, a.at.column) < std::tie(b.at.line, b.at.column);
  });
  for (auto& placed : faults_) out_.push_back(std::move(placed.fault));
}

bool Reader::read_number(const toml::node& node, std::string_view key, double& value, const Range& range, bool finite) {
  if (!node.is_number()) {
    add(node, key, fmt::format("it is {}", kind_of(node)), "Give a number");
    return false;
  }
  const double read =
      node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  if (std::isnan(read) || (finite && !std::isfinite(read))) {
    add(node, key, "it is not a finite number",
        "Give a number" + (range_text(range).empty() ? "" : " " + range_text(range)));
    return false;
  }
  if (!in_range(node, key, read, range)) return false;
  value = read;
  return true;
}

bool Reader::read_integer(const toml::node& node, std::string_view key, int& value, const Range& range) {
  const auto* integer = node.as_integer();
  if (integer == nullptr) {
    add(node, key, fmt::format("it is {}", kind_of(node)), "Give an integer, without a decimal point");
    return false;
  }
  const auto read = integer->get();
  if (!in_range(node, key, static_cast<double>(read), range)) return false;
  if (read != static_cast<int>(read)) {
    add(node, key, "out of range",
        fmt::format("It must be {} to {}", std::numeric_limits<int>::min(), std::numeric_limits<int>::max()));
    return false;
  }
  value = static_cast<int>(read);
  return true;
}

template <class T, class ReadItem>
void Reader::read_list(std::string_view key, std::vector<T>& value, ReadItem&& read_item) {
  const auto* node = find(key);
  if (node == nullptr) return;
  const auto* array = node->as_array();
  if (array == nullptr) {
    add(*node, key, "a list is wanted", fmt::format("Write {} = [...]", key));
    return;
  }
  std::vector<T> read(array->size());
  bool good = true;
  for (std::size_t i = 0; i < read.size(); ++i)
    good = read_item(*array->get(i), fmt::format("{}[{}]", key, i), read[i]) && good;
  if (good) value = std::move(read);
}

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

/// GDAL's names of things inside files (NETCDF:file.nc:z) are no paths.
bool names_a_dataset(const std::string& text) {
  const std::size_t colon = text.find(':');
  return colon != std::string::npos && colon > 1 &&
         std::all_of(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(colon),
                     [](unsigned char c) { return std::isupper(c) || std::isdigit(c) || c == '_'; });
}

void Reader::path(std::string_view key, fs::path& value, std::string_view) {
  const auto* node = find(key);
  std::string given = value.string();
  if (node != nullptr && !read_plain(*node, key, given, "a path in quotes")) return;
  std::vector<std::string> unset;
  const std::string expanded = expand(given, unset);
  for (const auto& name : unset) {
    if (node == nullptr) break;
    add(*node, key, fmt::format("the environment variable {} is not set", name),
        fmt::format("Set it: export {}=...", name));
  }
  if (!unset.empty()) return;
  const bool as_it_is = expanded.empty() || names_a_dataset(expanded);
  value = as_it_is ? fs::path(expanded) : (folder_ / expanded).lexically_normal();
}

void Reader::one_of(std::string_view key, int& index, const std::vector<std::string_view>& names, std::string_view) {
  const auto* node = find(key);
  std::string word;
  if (node == nullptr || !read_plain(*node, key, word, names_text(names).c_str())) return;
  const auto found = std::find(names.begin(), names.end(), word);
  if (found != names.end()) {
    index = static_cast<int>(found - names.begin());
    return;
  }
  const std::string near = nearest(word, {names.begin(), names.end()});
  add(*node, key, "no such choice",
      (near.empty() ? "" : fmt::format("Did you mean \"{}\"? ", near)) + "It must be " + names_text(names));
}

std::size_t Reader::begin_list(std::string_view key, std::size_t size, std::string_view) {
  const auto* node = find(key);
  lists_.push_back({nullptr, frames_.back().path + "." + std::string(key)});
  if (node == nullptr) return size;
  const auto* array = node->as_array();
  if (array == nullptr ||
      !std::all_of(array->begin(), array->end(), [](const toml::node& item) { return item.is_table(); })) {
    add(*node, key, "a list of tables is wanted",
        fmt::format("Write [[{}]] above the keys of each one", lists_.back().path));
    return size;
  }
  lists_.back().items = array;
  return array->size();
}

void Reader::begin_item(std::size_t item) {
  const List& items = lists_.back();
  Frame frame;
  frame.path = items.path;
  frame.name = fmt::format("[[{}]]", items.path);
  if (items.items != nullptr) frame.table = items.items->get(item)->as_table();
  frames_.push_back(std::move(frame));
}

}  // namespace

std::unique_ptr<Visitor> make_table_reader(const toml::table& root, std::string shown, fs::path folder,
                                           std::string_view stage, std::vector<Fault>& faults) {
  return std::make_unique<Reader>(root, std::move(shown), std::move(folder), stage, faults);
}

}  // namespace talus::recipe
