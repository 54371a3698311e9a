// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "preprocess/ensemble/listed_members.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>
#include <vector>

#include "common/ensemble/options.hpp"
#include "common/error.hpp"
#include "preprocess/ensemble/csv.hpp"

namespace talus::preprocess {
namespace {

[[noreturn]] void refuse_listed(const std::filesystem::path& file, const CsvField& at, const std::string& what,
                                const std::string& why, const std::string& mend) {
  throw DataError(Fault{fmt::format("{}:{}:{}: {}", file.string(), at.line, at.column, what), why, mend});
}

void check_keys(const std::filesystem::path& file, const std::vector<CsvField>& header) {
  std::set<std::string> keys;
  for (const CsvField& field : header) {
    if (field.text.empty() || is_csv_number(field))
      refuse_listed(file, field, fmt::format("\"{}\" is no key", field.text), "the first row names what varies",
                    "Write a key with its tables, such as solve.base.friction_angle_deg");
    if (!keys.insert(field.text).second)
      refuse_listed(file, field, field.text + " is there twice", "one value would hide the other",
                    "Leave one of the columns out");
  }
}

MemberColumn column_of(const std::filesystem::path& file, const std::vector<std::vector<CsvField>>& rows,
                       std::size_t place) {
  MemberColumn column{rows[0][place].text, {}, {}};
  bool numbers = true;
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const CsvField& field = rows[row][place];
    if (field.text.empty())
      refuse_listed(file, field, "an empty field", fmt::format("{} has no value there", column.key), "Give one");
    numbers = numbers && is_csv_number(field);
  }
  for (std::size_t row = 1; row < rows.size(); ++row) {
    const CsvField& field = rows[row][place];
    if (numbers) {
      column.values.push_back(csv_number(file, field));
      continue;
    }
    const auto found = std::find(column.words.begin(), column.words.end(), field.text);
    column.values.push_back(static_cast<double>(found - column.words.begin()));
    if (found == column.words.end()) column.words.push_back(field.text);
  }
  return column;
}

}  // namespace

void take_listed(MemberTable& table, const std::filesystem::path& file) {
  const std::vector<std::vector<CsvField>> rows = read_csv(file);
  if (rows.size() < 2)
    throw DataError(Fault{file.string() + ": no members", "it has no row below that of the keys",
                          "Give a row of keys, then a row of values for each member"});
  if (rows.size() - 1 > static_cast<std::size_t>(most_members))
    throw DataError(Fault{fmt::format("{}: {} members", file.string(), rows.size() - 1),
                          fmt::format("up to {} are run", most_members), "Give fewer"});
  check_keys(file, rows[0]);
  table.count = static_cast<std::int64_t>(rows.size() - 1);
  for (std::size_t place = 0; place < rows[0].size(); ++place) table.columns.push_back(column_of(file, rows, place));
}

}  // namespace talus::preprocess
