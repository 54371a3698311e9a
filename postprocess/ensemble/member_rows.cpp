// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/member_rows.hpp"

#include <cmath>

#include <fmt/format.h>

#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

std::string cell(const RowColumn& column, std::size_t member) {
  const double value = column.values[member];
  if (std::isnan(value)) return "";
  return column.words.empty() ? fmt::format("{}", value) : csv_field(column.words.at(static_cast<std::size_t>(value)));
}

}  // namespace

const char* word_of(MemberState state) {
  constexpr const char* words[] = {"waiting", "counted", "failed", "left out"};
  return words[static_cast<std::size_t>(state)];
}

MemberRows member_rows(const Ensemble& ensemble, const Options& options, const std::optional<Survey>& survey) {
  const EnsembleCounts& counts = ensemble.counts;
  const std::vector<std::string> none(counts.states.size());
  MemberRows rows{counts.states, none, none, {}};
  for (const MemberWords& failure : counts.failures)
    rows.failures.at(static_cast<std::size_t>(failure.member)) = failure.words;
  for (const Finding& warning : counts.findings) {
    if (warning.member == Finding::no_member || warning.severity != Severity::warning) continue;
    std::string& words = rows.warnings.at(static_cast<std::size_t>(warning.member));
    words += (words.empty() ? "" : "; ") + warning.message;
  }
  if (const auto& names = ensemble.table.names; !names.empty()) {
    RowColumn column{ColumnKind::input, "name", "", ensemble.table.slides ? "name of the slide" : "name", {}, names};
    for (std::size_t k = 0; k < names.size(); ++k) column.values.push_back(static_cast<double>(k));
    rows.columns.push_back(std::move(column));
  }
  for (const MemberColumn& column : ensemble.table.columns)
    rows.columns.push_back({ColumnKind::input, column.key, "", column.key, column.values, column.words});
  for (const ResultNumber& number : result_numbers) {
    RowColumn column{ColumnKind::result, number.name, number.unit, number.meaning, {}, {}};
    for (std::size_t k = 0; k < counts.results.size(); ++k)
      column.values.push_back(counts.states[k] == MemberState::counted ? counts.results[k].*(number.value) : nan);
    rows.columns.push_back(std::move(column));
  }
  if (survey)
    for (RowColumn& column : member_scores(ensemble, *survey, options.deposit_threshold))
      rows.columns.push_back(std::move(column));
  return rows;
}

std::string members_csv(const MemberRows& rows, const char* called) {
  std::string text = std::string(called) + ",state";
  for (const RowColumn& column : rows.columns) text += "," + csv_field(column.name);
  text += ",failure,warnings\n";
  for (std::size_t k = 0; k < rows.states.size(); ++k) {
    text += fmt::format("{},{}", k, word_of(rows.states[k]));
    for (const RowColumn& column : rows.columns) text += "," + cell(column, k);
    text += "," + csv_field(rows.failures[k]) + "," + csv_field(rows.warnings[k]) + "\n";
  }
  return text;
}

}  // namespace talus::postprocess
