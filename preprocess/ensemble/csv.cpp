// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <system_error>

#include "common/error.hpp"
#include "common/whole_text.hpp"

namespace talus::preprocess {
namespace {

namespace fs = std::filesystem;

using Row = std::vector<CsvField>;

[[noreturn]] void refuse_place(const fs::path& file, const CsvField& at, const std::string& what,
                               const std::string& why, const std::string& mend) {
  throw DataError(Fault{fmt::format("{}:{}:{}: {}", file.string(), at.line, at.column, what), why, mend});
}

/// The table without the mark of its byte order.
std::string text_of(const fs::path& file) {
  std::string text = whole_text(file, std::uintmax_t{64} << 20, [&](const std::string& reason) {
    throw DataError(Fault{file.string() + ": the table cannot be read", reason, "Check the path"});
  });
  return text.starts_with("\xEF\xBB\xBF") ? text.substr(3) : text;
}

/// Walks over the text of a file, field by field.
class CsvWalk {
 public:
  CsvWalk(const fs::path& file, const std::string& text) : file_(file), text_(text) {}

  /// The next row that says something; none at the end.
  std::optional<Row> next() {
    while (at_ < text_.size()) {
      if (text_[at_] == '#') {
        skip_line();
        continue;
      }
      Row row = read_row();
      if (row.size() > 1 || !row[0].text.empty()) return row;
    }
    return std::nullopt;
  }

 private:
  void step() {
    if (text_[at_] == '\n') {
      ++line_;
      begin_ = at_ + 1;
    }
    ++at_;
  }
  void skip_line() {
    while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    if (at_ < text_.size()) step();
  }
  bool blank() const { return at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\r'); }
  bool ends_field() const { return at_ >= text_.size() || text_[at_] == ',' || text_[at_] == '\n'; }
  void skip_blanks() {
    while (blank()) ++at_;
  }

  Row read_row() {
    Row row;
    for (;;) {
      row.push_back(read_field());
      if (at_ >= text_.size()) return row;
      const bool more = text_[at_] == ',';
      step();
      if (!more) return row;
    }
  }

  CsvField read_field() {
    skip_blanks();
    CsvField field{"", line_, static_cast<int>(at_ - begin_) + 1};
    if (at_ < text_.size() && text_[at_] == '"') {
      read_quoted(field);
    } else {
      while (!ends_field()) field.text += text_[at_++];
      while (!field.text.empty() &&
             (field.text.back() == ' ' || field.text.back() == '\t' || field.text.back() == '\r'))
        field.text.pop_back();
    }
    return field;
  }

  void read_quoted(CsvField& field) {
    ++at_;
    for (;; step()) {
      if (at_ >= text_.size())
        refuse_place(file_, field, "a quote is not closed", "the file ends within the field", "Add the closing quote");
      if (text_[at_] != '"') {
        field.text += text_[at_];
      } else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"') {
        field.text += text_[++at_];
      } else {
        break;
      }
    }
    ++at_;
    skip_blanks();
    if (!ends_field())
      refuse_place(file_, field, "text stands behind the closing quote", "a comma or the end of the line is expected",
                   "Double quotes within a field");
  }

  const fs::path& file_;
  const std::string& text_;
  std::size_t at_ = 0, begin_ = 0;
  int line_ = 1;
};

std::optional<double> number_of(const std::string& text) {
  double value = 0;
  const char* first = text.data() + (text.starts_with('+') ? 1 : 0);
  const auto [end, error] = std::from_chars(first, text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::vector<Row> read_csv(const fs::path& file) {
  const std::string text = text_of(file);
  CsvWalk walk(file, text);
  std::vector<Row> rows;
  while (auto row = walk.next()) {
    if (!rows.empty() && row->size() != rows.front().size())
      refuse_place(file, row->front(), fmt::format("a row of {} fields", row->size()),
                   fmt::format("the first has {}", rows.front().size()), "Mend the row");
    rows.push_back(std::move(*row));
  }
  return rows;
}

bool is_csv_number(const CsvField& field) { return number_of(field.text).has_value(); }

double csv_number(const fs::path& file, const CsvField& field) {
  if (const auto number = number_of(field.text)) return *number;
  refuse_place(file, field, fmt::format("\"{}\" is no number", field.text), "a finite number is expected",
               "Write it with a point for its decimals");
}

std::vector<DensityRow> read_density(const fs::path& file) {
  std::vector<Row> rows = read_csv(file);
  if (!rows.empty() && std::none_of(rows[0].begin(), rows[0].end(), is_csv_number)) rows.erase(rows.begin());
  const auto refuse = [&](const std::string& what, const std::string& why) {
    throw DataError(Fault{file.string() + ": " + what, why, "Give lines of a value and its probability density"});
  };
  if (rows.size() < 2) refuse("fewer than two rows", "no value lies between them");
  if (rows[0].size() != 2) refuse(fmt::format("{} columns", rows[0].size()), "two are expected");
  std::vector<DensityRow> densities;
  for (const Row& row : rows) {
    const DensityRow one{csv_number(file, row[0]), csv_number(file, row[1])};
    if (!densities.empty() && !(one.value > densities.back().value))
      refuse_place(file, row[0], fmt::format("{:g} does not lie above the value before", one.value),
                   "the density is drawn from value to value", "Put the rows in order");
    if (one.density < 0)
      refuse_place(file, row[1], fmt::format("{:g} is negative", one.density), "no value is less than impossible",
                   "Mend the density");
    densities.push_back(one);
  }
  if (std::none_of(densities.begin(), densities.end(), [](const DensityRow& r) { return r.density > 0; }))
    refuse("all densities are 0", "no value could be drawn");
  return densities;
}

}  // namespace talus::preprocess
