// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/csv.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <fmt/format.h>

#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "common/stage/findings.hpp"
#include "common/table_words.hpp"
#include "common/text_encoding.hpp"
#include "common/whole_text.hpp"

namespace talus::preprocess {
namespace {

namespace fs = std::filesystem;

/// A field and where it begins, both counted from 1.
struct CsvField {
  std::string text;
  int line = 0, column = 0;
};
using Row = std::vector<CsvField>;

[[noreturn]] void refuse_place(const fs::path& file, const CsvField& at, const std::string& what,
                               const std::string& why, const std::string& mend) {
  throw DataError({fmt::format("{}:{}:{}: {}", file.string(), at.line, at.column, what), why, mend});
}

/// Walks over the text of a file, field by field.
class CsvWalk {
 public:
  CsvWalk(const fs::path& file, const std::string& text) : file_(file), text_(text), separator_(separator_of(text)) {}
  bool commas_are_decimal() const { return separator_ != ','; }

  /// The next row that says something; none at the end.
  std::optional<Row> next() {
    while (at_ < text_.size()) {
      if (text_[at_] == '#') {
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
        if (at_ < text_.size()) step();
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
  bool is_blank(char c) const { return c != separator_ && (c == ' ' || c == '\t' || c == '\r'); }
  bool blank() const { return at_ < text_.size() && is_blank(text_[at_]); }
  bool ends_field() const { return at_ >= text_.size() || text_[at_] == separator_ || text_[at_] == '\n'; }
  void skip_blanks() {
    while (blank()) ++at_;
  }

  Row read_row() {
    Row row;
    for (;;) {
      row.push_back(read_field());
      if (at_ >= text_.size()) return row;
      const bool more = text_[at_] == separator_;
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
      while (!field.text.empty() && is_blank(field.text.back())) field.text.pop_back();
    }
    return field;
  }

  void read_quoted(CsvField& field) {
    ++at_;
    for (;; step()) {
      if (at_ >= text_.size())
        refuse_place(file_, field, "a quote is not closed", "the file ends within the field", "Add the closing quote");
      if (text_[at_] != '"')
        field.text += text_[at_];
      else if (at_ + 1 < text_.size() && text_[at_ + 1] == '"')
        field.text += text_[++at_];
      else
        break;
    }
    ++at_;
    skip_blanks();
    if (!ends_field())
      refuse_place(file_, field, "text stands behind the closing quote",
                   "a separator or the end of the line is expected", "Double quotes within a field");
  }

  /// Semicolon, tab or comma, whichever of them the first line has, but for comments and what is quoted.
  static char separator_of(const std::string& text) {
    for (const std::string& line : lines_in(text)) {
      if (line.starts_with('#')) continue;
      bool quoted = false;
      std::string bare;
      for (const char c : line) {
        if (c == '"') quoted = !quoted;
        if (!quoted) bare += c;
      }
      if (bare.find_first_not_of(" \t\r") == std::string::npos) continue;
      for (const char c : {';', ','})
        if (bare.find(c) != std::string::npos) return c;
      return bare.find('\t') == std::string::npos ? ',' : '\t';
    }
    return ',';
  }

  const fs::path& file_;
  const std::string& text_;
  char separator_;
  std::size_t at_ = 0, begin_ = 0;
  int line_ = 1;
};

/// Reads the numbers of a table that semicolons or tabs part with decimal commas too. Throws DataError with line and
/// column: a number that can be read in two ways, or whose thousands a sign parts.
void settle_numbers(const fs::path& file, std::vector<Row>& rows, bool decimal_commas) {
  NumberDoubts doubts;
  const auto refuse = [&](const NumberDoubt& doubt) {
    const CsvField at{doubt.written, doubt.line, static_cast<int>(doubt.column)};
    refuse_place(file, at, fmt::format("\"{}\"", doubt.written), doubt.why, doubt.mend);
  };
  for (Row& row : rows)
    for (CsvField& field : row) {
      std::string point = field.text;
      if (decimal_commas && std::ranges::count(point, ',') == 1) std::ranges::replace(point, ',', '.');
      if (signed_number(point)) {
        if (const auto doubt = doubts.look(field.text, field.line, static_cast<std::size_t>(field.column)))
          refuse(*doubt);
        field.text = point;
      } else if (is_grouped(field.text)) {
        refuse_place(file, field, fmt::format("\"{}\" is no number", field.text),
                     "a sign parts its thousands, or its decimals otherwise than by a point",
                     "Write thousands without a sign, and a point for decimals");
      }
    }
  if (const auto doubt = doubts.left()) refuse(*doubt);
}

/// A file as RFC 4180 describes it: fields between commas, semicolons or tabs, those in double quotes with anything in
/// them, a doubled quote for one; blank lines and lines that begin with # are skipped, blanks around a field too. A
/// byte order mark is passed over. Throws DataError with line and column: not readable, UTF-16, longer than 64 MB, an
/// open quote, rows that have not as many fields as the first, doubtful numbers.
std::vector<Row> read_csv(const fs::path& file) {
  std::string text = whole_text(file, std::uintmax_t{64} << 20, [&](const std::string& reason) {
    throw DataError({file.string() + ": the table cannot be read", reason, "Check the path"});
  });
  if (const std::string_view encoding = wide_encoding(text); !encoding.empty())
    throw DataError({fmt::format("{}: its text is {}", file.string(), encoding), "a table is wanted as UTF-8",
                     mend_of_encoding(encoding, file.string())});
  if (text.starts_with("\xEF\xBB\xBF")) text.erase(0, 3);
  if (!is_utf8(text)) {
    warn("text-encoding", file.string() + ": its text is not UTF-8 and is taken as CP1252 (Western European)");
    text = as_utf8(text);
  }
  CsvWalk walk(file, text);
  std::vector<Row> rows;
  while (auto row = walk.next()) {
    if (!rows.empty() && row->size() != rows.front().size())
      refuse_place(file, row->front(), fmt::format("a row of {} fields", row->size()),
                   fmt::format("the first has {}", rows.front().size()), "Mend the row");
    rows.push_back(std::move(*row));
  }
  settle_numbers(file, rows, walk.commas_are_decimal());
  return rows;
}

bool is_csv_number(const CsvField& field) { return signed_number(field.text).has_value(); }

double csv_number(const fs::path& file, const CsvField& field) {
  if (const auto number = signed_number(field.text)) return *number;
  refuse_place(file, field, fmt::format("\"{}\" is no number", field.text), "a finite number is expected",
               "Write it with a point for its decimals");
}

void check_keys(const fs::path& file, const Row& header) {
  std::set<std::string> keys;
  for (const CsvField& field : header) {
    if (field.text.empty() || is_csv_number(field))
      refuse_place(file, field, fmt::format("\"{}\" is no key", field.text), "the first row names what varies",
                   "Write a key with its tables, such as solve.base.friction_angle_deg");
    if (!keys.insert(field.text).second)
      refuse_place(file, field, field.text + " is there twice", "one value would hide the other",
                   "Leave one of the columns out");
  }
}

}  // namespace

MemberColumn column_of(std::string key, const std::vector<std::string>& texts, NumberReader number) {
  MemberColumn column{std::move(key), {}, {}};
  const bool numbers = std::ranges::all_of(texts, [&](const std::string& text) { return number(text).has_value(); });
  for (const std::string& text : texts) {
    if (numbers) {
      column.values.push_back(*number(text));
      continue;
    }
    const auto known = std::find(column.words.begin(), column.words.end(), text);
    column.values.push_back(static_cast<double>(known - column.words.begin()));
    if (known == column.words.end()) column.words.push_back(text);
  }
  return column;
}

std::vector<DensityRow> read_density(const fs::path& file) {
  std::vector<Row> rows = read_csv(file);
  if (!rows.empty() && std::ranges::none_of(rows[0], is_csv_number)) rows.erase(rows.begin());
  const auto refuse = [&](const std::string& what, const std::string& why) {
    throw DataError({file.string() + ": " + what, why, "Give lines of a value and its probability density"});
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
  if (std::ranges::none_of(densities, [](const DensityRow& r) { return r.density > 0; }))
    refuse("all densities are 0", "no value could be drawn");
  return densities;
}

void take_listed(MemberTable& table, const std::filesystem::path& file) {
  const std::vector<Row> rows = read_csv(file);
  if (rows.size() < 2)
    throw DataError({file.string() + ": no members", "it has no row below that of the keys",
                     "Give a row of keys, then a row of values for each member"});
  if (rows.size() - 1 > static_cast<std::size_t>(most_members))
    throw DataError({fmt::format("{}: {} members", file.string(), rows.size() - 1),
                     fmt::format("up to {} are run", most_members), "Give fewer"});
  check_keys(file, rows[0]);
  table.count = static_cast<std::int64_t>(rows.size() - 1);
  for (std::size_t place = 0; place < rows[0].size(); ++place) {
    const std::string& key = rows[0][place].text;
    std::vector<std::string> texts;
    for (std::size_t row = 1; row < rows.size(); ++row) {
      const CsvField& field = rows[row][place];
      if (field.text.empty())
        refuse_place(file, field, "an empty field", fmt::format("{} has no value there", key), "Give one");
      texts.push_back(field.text);
    }
    table.columns.push_back(column_of(key, texts, signed_number));
  }
}

}  // namespace talus::preprocess
