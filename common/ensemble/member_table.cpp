// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/member_table.hpp"

#include <algorithm>
#include <cmath>
#include <regex>
#include <utility>

#include <fmt/format.h>

#include "common/ensemble/options.hpp"
#include "common/ensemble/used.hpp"
#include "common/recipe/recipe.hpp"
#include "common/run/sealed_file.hpp"
#include "common/whole_text.hpp"

namespace talus {

std::filesystem::path EnsemblePaths::domain(std::int64_t member) const {
  return folder() / fmt::format("domain.{:05}.vdb", member);
}

std::filesystem::path EnsemblePaths::counts(const MemberRange& part) const {
  return out / fmt::format("counts.{}-{}.h5", part.first, part.end);
}

std::filesystem::path EnsemblePaths::unfinished(const MemberRange& part) const {
  return out / fmt::format("unfinished.{}-{}.h5", part.first, part.end);
}

std::filesystem::path EnsemblePaths::run_folder(std::int64_t member) const {
  return folder() / fmt::format("{:05}", member);
}

std::vector<std::filesystem::path> EnsemblePaths::found_counts() const {
  if (std::filesystem::exists(counts())) return {counts()};
  static const std::regex of_a_part(R"(counts\.([0-9]{1,18})-[0-9]{1,18}\.h5)");
  std::vector<std::pair<std::int64_t, std::filesystem::path>> parts;
  std::error_code unreadable;
  for (const auto& entry : std::filesystem::directory_iterator(out, unreadable)) {
    std::smatch match;
    const std::string name = entry.path().filename().string();
    if (std::regex_match(name, match, of_a_part)) parts.emplace_back(std::stoll(match[1]), entry.path());
  }
  std::sort(parts.begin(), parts.end());
  std::vector<std::filesystem::path> files;
  for (auto& [first, file] : parts) files.push_back(std::move(file));
  return files;
}

void add_in_order(std::vector<MemberWords>& list, MemberWords words) {
  list.insert(std::ranges::upper_bound(list, words.member, {}, &MemberWords::member), std::move(words));
}

void write_member_words(h5::File& file, const std::string& group, const std::vector<MemberWords>& list) {
  file.make_group(group);
  for (std::size_t n = 0; n < list.size(); ++n) {
    const auto one = fmt::format("{}/{:06}", group, n);
    file.make_group(one);
    file.set_integer(one, "member", list[n].member);
    file.set_text(one, "words", list[n].words);
  }
}

std::vector<MemberWords> read_member_words(const h5::File& file, const std::string& group) {
  std::vector<MemberWords> list;
  if (!file.exists(group)) return list;
  for (const std::string& name : file.children(group)) {
    const auto one = fmt::format("{}/{}", group, name);
    list.push_back({file.integer(one, "member"), file.text(one, "words")});
  }
  return list;
}

namespace {

constexpr h5::Format members_format{"talus members", "a table of members"};

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

MemberColumn read_column(const h5::File& file, const std::string& path, std::int64_t count) {
  MemberColumn column;
  column.key = file.text(path, "key");
  column.words = lines_in(file.text(path, "words"));
  column.values = file.read<double>(path, {static_cast<hsize_t>(count)}, h5::finite);
  if (column.words.empty()) return column;
  for (const double value : column.values)
    if (value < 0 || value >= static_cast<double>(column.words.size()))
      file.refuse(fmt::format("dataset {} holds {:g}", path, value), "it is the place of no word");
  return column;
}

void write_slides(h5::File& file, const SlideTable& slides) {
  file.make_group("/slides");
  h5::write_text(file, "/slides/domains", lines_of(slides.domains));
  h5::write_grid(file, "/slides", slides.lattice);
  h5::write_windows(file, "/slides/windows", slides.windows);
  file.make_group("/slides/ground");
  h5::write_grid(file, "/slides/ground", slides.ground.grid);
  file.write_list<double>("/slides/ground/elevation", slides.ground.values);
}

/// A text for each member, written as one text by lines_of(): attributes hold 64 kB at most. Empty where there is none.
std::vector<std::string> read_text_of_each(const h5::File& file, const std::string& path, std::int64_t count) {
  if (!file.exists(path)) return {};
  std::vector<std::string> texts = lines_in(h5::read_text(file, path));
  if (texts.size() != static_cast<std::size_t>(count))
    file.refuse(fmt::format("dataset {} has {} lines", path, texts.size()), fmt::format("there are {} members", count));
  return texts;
}

SlideTable read_slides(const h5::File& file, std::int64_t count) {
  SlideTable slides;
  slides.domains = read_text_of_each(file, "/slides/domains", count);
  slides.lattice = h5::read_grid(file, "/slides");
  slides.windows = h5::read_windows(file, "/slides/windows", static_cast<std::size_t>(count));
  for (const CellWindow& w : slides.windows)
    if (w.columns == 0 || w.rows == 0 || !lies_in(w, slides.lattice))
      file.refuse(
          fmt::format("dataset /slides/windows holds {} x {} cells from {}, {}", w.columns, w.rows, w.column, w.row),
          fmt::format("the lattice has {} x {}", slides.lattice.columns, slides.lattice.rows));
  slides.ground.grid = h5::read_grid(file, "/slides/ground");
  slides.ground.values =
      file.read<double>("/slides/ground/elevation", {slides.ground.grid.count()}, h5::elevation_or_none);
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
  const auto found = std::ranges::find(failures, member, &MemberWords::member);
  return found == failures.end() ? nullptr : &*found;
}

const MemberColumn* MemberTable::find(const std::string& key) const {
  const auto found = std::ranges::find(columns, key, &MemberColumn::key);
  return found == columns.end() ? nullptr : &*found;
}

void write_member_table(const std::filesystem::path& path, const MemberTable& table) {
  h5::write_sealed(path, [&](h5::File& file) {
    h5::set_format(file, members_format);
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
      if (!texts->empty()) h5::write_text(file, where, lines_of(*texts));
    if (table.slides) write_slides(file, *table.slides);
    write_member_words(file, "/failures", table.failures);
    h5::write_facts(file, "/provenance", table.provenance);
  });
}

MemberTable read_member_table(const std::filesystem::path& path) {
  const h5::File file = h5::open_sealed(path, {path, "Run talus-preprocess again"}, members_format);
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
  if (fact(table.provenance, used_by_members) == ensemble_mark(recipe)) return;
  for (const auto& [name, mark] : {std::pair{"ensemble", recipe_of_members}, {"slides", recipe_of_slides}})
    judge_maker(
        recipe,
        {.file = file, .table = name, .mark = fact(table.provenance, mark), .program = "talus-preprocess", .key = ""});
}

}  // namespace talus
