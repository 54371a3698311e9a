// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/member_table.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/ensemble/budget_options.hpp"
#include "common/ensemble/ensemble_file.hpp"
#include "common/recipe/values.hpp"
#include "common/run/check_values.hpp"
#include "common/run/grid_attributes.hpp"

namespace talus {
namespace {

const EnsembleFileKind members_kind{{"talus members", "a table of members"}, "Run talus-preprocess again"};

/// Words of a column as one text, a line each.
std::string lines_of(const std::vector<std::string>& words) { return fmt::format("{}", fmt::join(words, "\n")); }

/// A number as a key of either kind takes it: keys that count refuse a decimal point.
std::string number_of_key(double value) {
  constexpr double exact = 9e15;  // whole numbers below that are doubles
  const bool whole = value == std::floor(value) && std::abs(value) < exact;
  return whole ? fmt::format("{:.0f}", value) : recipe::toml_number(value);
}

/// A word as a key takes it: true and false are no text.
std::string word_of_key(const std::string& word) {
  return word == "true" || word == "false" ? word : recipe::toml_text(word);
}

std::vector<std::string> words_of(const std::string& lines) {
  std::vector<std::string> words;
  for (std::size_t begin = 0; begin < lines.size();) {
    const auto end = std::min(lines.find('\n', begin), lines.size());
    words.push_back(lines.substr(begin, end - begin));
    begin = end + 1;
  }
  return words;
}

MemberColumn read_column(const h5::File& file, const std::string& path, std::int64_t count) {
  MemberColumn column;
  column.key = file.text(path, "key");
  column.words = words_of(file.text(path, "words"));
  column.values = file.read<double>(path, {static_cast<hsize_t>(count)});
  h5::check_values<double>(file, path, column.values, h5::finite);
  if (column.words.empty()) return column;
  for (const double value : column.values)
    if (value < 0 || value >= static_cast<double>(column.words.size()))
      file.refuse(fmt::format("dataset {} holds {:g}", path, value), "it is the place of no word");
  return column;
}

/// A list of texts without line breaks as a dataset of bytes: attributes hold 64 kB at most.
void write_texts(h5::File& file, const std::string& path, const std::vector<std::string>& texts) {
  const std::string all = lines_of(texts);
  const std::vector<std::uint8_t> bytes(all.begin(), all.end());
  file.write<std::uint8_t>(path, {bytes.size()}, bytes);
}

std::vector<std::string> read_texts(const h5::File& file, const std::string& path) {
  const auto bytes = file.read_list<std::uint8_t>(path);
  return words_of({bytes.begin(), bytes.end()});
}

void write_slides(h5::File& file, const SlideTable& slides) {
  file.make_group("/slides");
  write_texts(file, "/slides/domains", slides.domains);
  h5::write_grid(file, "/slides", slides.lattice);
  std::vector<std::int32_t> windows;
  for (const CellWindow& w : slides.windows) windows.insert(windows.end(), {w.column, w.row, w.columns, w.rows});
  file.write<std::int32_t>("/slides/windows", {slides.windows.size(), 4}, windows);
  file.make_group("/slides/ground");
  h5::write_grid(file, "/slides/ground", slides.ground.grid);
  file.write<double>("/slides/ground/elevation", {slides.ground.values.size()}, slides.ground.values);
}

/// Refuses a window that is not on the lattice.
void check_window(const h5::File& file, const SlideTable& slides, const CellWindow& w) {
  const MapGrid& grid = slides.lattice;
  if (w.column >= 0 && w.row >= 0 && w.columns > 0 && w.rows > 0 && w.columns <= grid.columns - w.column &&
      w.rows <= grid.rows - w.row)
    return;
  file.refuse(
      fmt::format("dataset /slides/windows holds {} x {} cells from {}, {}", w.columns, w.rows, w.column, w.row),
      fmt::format("the lattice has {} x {}", grid.columns, grid.rows));
}

/// A text for each member; empty where the file has none.
std::vector<std::string> read_text_of_each(const h5::File& file, const std::string& path, std::int64_t count) {
  if (!file.exists(path)) return {};
  std::vector<std::string> texts = read_texts(file, path);
  if (texts.size() != static_cast<std::size_t>(count))
    file.refuse(fmt::format("dataset {} has {} lines", path, texts.size()), fmt::format("there are {} members", count));
  return texts;
}

SlideTable read_slides(const h5::File& file, std::int64_t count) {
  SlideTable slides;
  slides.domains = read_text_of_each(file, "/slides/domains", count);
  slides.lattice = h5::read_grid(file, "/slides");
  const auto windows = file.read<std::int32_t>("/slides/windows", {static_cast<hsize_t>(count), 4});
  for (std::size_t at = 0; at < windows.size(); at += 4) {
    slides.windows.push_back({windows[at], windows[at + 1], windows[at + 2], windows[at + 3]});
    check_window(file, slides, slides.windows.back());
  }
  slides.ground.grid = h5::read_grid(file, "/slides/ground");
  slides.ground.values =
      file.read<double>("/slides/ground/elevation", {static_cast<hsize_t>(slides.ground.grid.count())});
  h5::check_values<double>(file, "/slides/ground/elevation", slides.ground.values, h5::finite_or_none);
  return slides;
}

}  // namespace

std::vector<std::string> MemberTable::values_of(std::int64_t member, const std::string& prefix) const {
  std::vector<std::string> values;
  for (const MemberColumn& column : columns) {
    if (!column.key.starts_with(prefix)) continue;
    const double value = column.values.at(static_cast<std::size_t>(member));
    values.push_back(
        column.key + "=" +
        (column.words.empty() ? number_of_key(value) : word_of_key(column.words.at(static_cast<std::size_t>(value)))));
  }
  return values;
}

std::string MemberTable::name_of(std::int64_t member) const {
  if (!names.empty()) return names.at(static_cast<std::size_t>(member));
  return fmt::format("member {}", member);
}

std::string MemberTable::names_of(const std::vector<std::int64_t>& members, std::size_t most) const {
  std::string text;
  for (std::size_t n = 0; n < members.size() && n < most; ++n) text += (n > 0 ? ", " : "") + name_of(members[n]);
  return members.size() > most ? text + fmt::format(" and {} more", members.size() - most) : text;
}

const MemberWords* MemberTable::failure_of(std::int64_t member) const {
  const auto found =
      std::find_if(failures.begin(), failures.end(), [&](const auto& one) { return one.member == member; });
  return found == failures.end() ? nullptr : &*found;
}

const MemberColumn* MemberTable::find(const std::string& key) const {
  const auto found = std::find_if(columns.begin(), columns.end(), [&](const auto& one) { return one.key == key; });
  return found == columns.end() ? nullptr : &*found;
}

void write_member_table(const std::filesystem::path& path, const MemberTable& table) {
  write_ensemble_file(path, members_kind, [&](h5::File& file) {
    file.set_text("/", "design", table.design);
    file.set_integer("/", "seed", table.seed);
    file.set_integer("/", "members", table.count);
    file.set_integer("/", "sample_size", table.sample_size);
    file.make_group("/keys");
    for (std::size_t n = 0; n < table.columns.size(); ++n) {
      const auto column = fmt::format("/keys/{:03}", n);
      file.write<double>(column, {static_cast<hsize_t>(table.count)}, table.columns[n].values);
      file.set_text(column, "key", table.columns[n].key);
      file.set_text(column, "words", lines_of(table.columns[n].words));
    }
    file.write<std::uint8_t>("/own_domain", {static_cast<hsize_t>(table.count)}, table.own_domain);
    for (const auto& [where, texts] : {std::pair{"/names", &table.names}, std::pair{"/rows", &table.rows}})
      if (!texts->empty()) write_texts(file, where, *texts);
    if (table.slides) write_slides(file, *table.slides);
    write_member_words(file, "/failures", table.failures);
    h5::write_facts(file, "/provenance", table.provenance);
  });
}

MemberTable read_member_table(const std::filesystem::path& path) {
  const h5::File file = open_ensemble_file(path, members_kind);
  MemberTable table;
  table.design = file.text("/", "design");
  table.seed = file.integer("/", "seed");
  table.count = file.integer("/", "members");
  table.sample_size = file.integer("/", "sample_size");
  if (table.count < 1) file.refuse("has no members", fmt::format("attribute members is {}", table.count));
  for (const std::string& name : file.children("/keys"))
    table.columns.push_back(read_column(file, "/keys/" + name, table.count));
  table.own_domain = file.read<std::uint8_t>("/own_domain", {static_cast<hsize_t>(table.count)});
  table.names = read_text_of_each(file, "/names", table.count);
  table.rows = read_text_of_each(file, "/rows", table.count);
  for (const std::string& row : table.rows)
    if (!row.empty() && find_budget_row(row) == nullptr)
      file.refuse(fmt::format("dataset /rows names \"{}\"", row), "a budget has no such row");
  if (file.exists("/slides")) table.slides = read_slides(file, table.count);
  table.failures = read_member_words(file, "/failures");
  for (const MemberWords& failure : table.failures)
    if (failure.member < 0 || failure.member >= table.count)
      file.refuse(fmt::format("group /failures names member {}", failure.member),
                  fmt::format("there are {} members, counted from 0", table.count));
  table.provenance = h5::read_facts(file, "/provenance");
  return table;
}

void judge_members(const recipe::Recipe& recipe, const std::filesystem::path& file, const MemberTable& table) {
  for (const auto& [name, mark] : {std::pair{"ensemble", recipe_of_members}, {"slides", recipe_of_slides}})
    judge_maker(
        recipe,
        {.file = file, .table = name, .mark = fact(table.provenance, mark), .program = "talus-preprocess", .key = ""});
}

}  // namespace talus
