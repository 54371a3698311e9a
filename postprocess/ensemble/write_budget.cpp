// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of an error budget as comma-separated values, as JSON and as words.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "postprocess/ensemble/budget_table.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {
namespace {

using OrderedJson = nlohmann::ordered_json;

/// The numbers of a line by their names, in the order of the columns.
std::vector<std::pair<std::string, double>> named_numbers(const BudgetTable& table, const BudgetLine& line) {
  const MemberResult &n = line.result, &own = table.own.result;
  std::vector<std::pair<std::string, double>> numbers{
      {"deposit_elsewhere_percent", 100 * line.elsewhere},
      {"largest_thickness_change_m", line.largest_change},
      {"p99_thickness_change_m", line.p99_change},
      {"run_out_m", n.run_out},
      {"run_out_change_m", n.run_out - own.run_out},
      {"run_out_change_percent", 100 * (n.run_out / own.run_out - 1)},
      {"footprint_overlap", line.overlap},
      {"deposit_volume_change_percent", 100 * (line.volume / table.own.volume - 1)},
      {"largest_speed_m_s", n.largest_speed},
      {"largest_speed_change_m_s", n.largest_speed - own.largest_speed},
      {"p99_speed_m_s", n.p99_speed},
      {"p99_speed_change_m_s", n.p99_speed - own.p99_speed}};
  for (std::size_t s = 0; s < table.scores.size(); ++s)
    numbers.emplace_back(table.scores[s], s < line.scores.size() ? line.scores[s] : nan);
  numbers.emplace_back("steps", n.steps);
  numbers.emplace_back("wall_time_s", n.wall_time);
  return numbers;
}

OrderedJson number_or_none(double value) { return std::isfinite(value) ? OrderedJson(value) : OrderedJson(); }

OrderedJson line_json(const BudgetTable& table, const BudgetLine& line) {
  OrderedJson json{{"run", line.name},         {"row", line.row->name}, {"kind", kind_name(line.row->kind)},
                   {"title", line.row->title}, {"what", line.words},    {"state", word_of(line.state)},
                   {"reason", line.reason},    {"values", line.values}, {"warnings", line.warnings}};
  for (const auto& [name, value] : named_numbers(table, line)) json[name] = number_or_none(value);
  return json;
}

}  // namespace

std::string budget_csv(const BudgetTable& table) {
  std::string text = "run,row,kind,state,what";
  for (const auto& [name, value] : named_numbers(table, table.own)) text += "," + name;
  text += ",values,reason,warnings\n";
  for (const BudgetLine& line : table.lines) {
    text += fmt::format("{},{},{},{},{}", line.name, line.row->name, kind_name(line.row->kind), word_of(line.state),
                        csv_field(line.words));
    for (const auto& [name, value] : named_numbers(table, line))
      text += std::isfinite(value) ? fmt::format(",{:.9g}", value) : ",";
    for (const std::string& words : {fmt::format("{}", fmt::join(line.values, " ")), line.reason, line.warnings})
      text += "," + csv_field(words);
    text += "\n";
  }
  return text;
}

OrderedJson budget_json(const BudgetTable& table) {
  OrderedJson own{{"run_out_m", number_or_none(table.own.result.run_out)},
                  {"largest_speed_m_s", number_or_none(table.own.result.largest_speed)},
                  {"p99_speed_m_s", number_or_none(table.own.result.p99_speed)},
                  {"deposit_volume_m3", number_or_none(table.own.volume)},
                  {"steps", number_or_none(table.own.result.steps)},
                  {"wall_time_s", number_or_none(table.own.result.wall_time)}};
  for (std::size_t s = 0; s < table.scores.size(); ++s) own[table.scores[s]] = number_or_none(table.own.scores[s]);
  OrderedJson json{{"own", std::move(own)}, {"rows", OrderedJson::array()}};
  for (const BudgetLine& line : table.lines) json["rows"].push_back(line_json(table, line));
  return json;
}

std::string budget_words(const BudgetTable& table) {
  const auto name_of = [](const BudgetLine& line) { return fmt::format("{} ({})", line.row->title, line.name); };
  std::size_t width = 0;
  for (const BudgetLine& line : table.lines) width = std::max(width, name_of(line).size());
  std::string text =
      fmt::format("{:<{}}  {:<9} {:>12} {:>12}\n", "error budget", width, "kind", "elsewhere", "run-out");
  for (const BudgetLine& line : table.lines) {
    const std::string start = fmt::format("{:<{}}  {:<9}", name_of(line), width, kind_name(line.row->kind));
    if (line.state == MemberState::counted)
      text += fmt::format("{} {:>10.2f} % {:>+10.0f} m\n", start, 100 * line.elsewhere,
                          line.result.run_out - table.own.result.run_out);
    else
      text += fmt::format("{} {}: {}\n", start, word_of(line.state), line.reason);
    if (!line.warnings.empty()) text += fmt::format("{:<{}}  warning: {}\n", "", width, line.warnings);
  }
  return text;
}

}  // namespace talus::postprocess
