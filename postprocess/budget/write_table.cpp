// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The table of an error budget as comma-separated values, as JSON and as words.
#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include "common/stage/identity.hpp"
#include "postprocess/budget/budget_table.hpp"
#include "postprocess/fields/csv_field.hpp"

namespace talus::postprocess {
namespace {

using OrderedJson = nlohmann::ordered_json;

const char* state_word(BudgetState state) {
  switch (state) {
    case BudgetState::done: return "done";
    case BudgetState::failed: return "failed";
    case BudgetState::left_out: return "left out";
    case BudgetState::waiting: break;
  }
  return "waiting";
}

/// The numbers of a line by their names, in the order of the columns.
std::vector<std::pair<std::string, double>> named_numbers(const BudgetTable& table, const BudgetLine& line) {
  const BudgetNumbers &n = line.numbers, &own = table.own;
  std::vector<std::pair<std::string, double>> numbers{
      {"deposit_elsewhere_percent", 100 * line.elsewhere},
      {"largest_thickness_change_m", line.largest_change},
      {"p99_thickness_change_m", line.p99_change},
      {"run_out_m", n.run_out},
      {"run_out_change_m", n.run_out - own.run_out},
      {"run_out_change_percent", 100 * (n.run_out / own.run_out - 1)},
      {"footprint_overlap", line.overlap},
      {"deposit_volume_change_percent", 100 * (n.volume / own.volume - 1)},
      {"largest_speed_m_s", n.largest_speed},
      {"largest_speed_change_m_s", n.largest_speed - own.largest_speed},
      {"p99_speed_m_s", n.p99_speed},
      {"p99_speed_change_m_s", n.p99_speed - own.p99_speed}};
  for (std::size_t s = 0; s < table.scores.size(); ++s)
    numbers.emplace_back(table.scores[s].key, s < line.scores.size() ? line.scores[s] : nan);
  numbers.emplace_back("steps", n.steps);
  numbers.emplace_back("wall_time_s", n.wall_time);
  return numbers;
}

OrderedJson number_or_none(double value) { return std::isfinite(value) ? OrderedJson(value) : OrderedJson(); }

OrderedJson line_json(const BudgetTable& table, const BudgetLine& line) {
  OrderedJson json{{"run", line.run.name},
                   {"row", line.run.row},
                   {"kind", kind_name(line.row->kind)},
                   {"what", line.run.words},
                   {"state", state_word(line.run.state)},
                   {"reason", line.run.reason},
                   {"values", line.run.values}};
  for (const auto& [name, words] : line.run.accepted) json[name] = words;
  if (!line.run.warnings.empty()) json["warnings"] = line.run.warnings;
  for (const auto& [name, value] : named_numbers(table, line)) json[name] = number_or_none(value);
  return json;
}

}  // namespace

std::string budget_csv(const BudgetTable& table) {
  std::string text = "run,row,kind,state,what";
  if (!table.lines.empty())
    for (const auto& [name, value] : named_numbers(table, table.lines.front())) text += "," + name;
  text += ",values,reason\n";
  for (const BudgetLine& line : table.lines) {
    text += fmt::format("{},{},{},{},{}", line.run.name, line.run.row, kind_name(line.row->kind),
                        state_word(line.run.state), csv_field(line.run.words));
    for (const auto& [name, value] : named_numbers(table, line))
      text += std::isfinite(value) ? fmt::format(",{:.9g}", value) : ",";
    text +=
        "," + csv_field(fmt::format("{}", fmt::join(line.run.values, " "))) + "," + csv_field(line.run.reason) + "\n";
  }
  return text;
}

std::string budget_json_text(const BudgetTable& table, const Run& run) {
  OrderedJson json{{"scene", run.summary.scene}, {"run_id", fact(run.summary.provenance, run_id)}};
  OrderedJson own{{"run_out_m", number_or_none(table.own.run_out)},
                  {"largest_speed_m_s", number_or_none(table.own.largest_speed)},
                  {"p99_speed_m_s", number_or_none(table.own.p99_speed)},
                  {"deposit_volume_m3", number_or_none(table.own.volume)},
                  {"steps", number_or_none(table.own.steps)},
                  {"wall_time_s", number_or_none(table.own.wall_time)}};
  for (const BudgetScore& score : table.scores) own[score.key] = number_or_none(score.own);
  json["own"] = std::move(own);
  json["rows"] = OrderedJson::array();
  for (const BudgetLine& line : table.lines) json["rows"].push_back(line_json(table, line));
  return json.dump(2) + "\n";
}

std::string budget_words(const BudgetTable& table) {
  const auto name_of = [](const BudgetLine& line) { return fmt::format("{} ({})", line.row->title, line.run.name); };
  std::size_t width = 0;
  for (const BudgetLine& line : table.lines) width = std::max(width, name_of(line).size());
  std::string text =
      fmt::format("{:<{}}  {:<9} {:>12} {:>12}\n", "error budget", width, "kind", "elsewhere", "run-out");
  for (const BudgetLine& line : table.lines) {
    const std::string start = fmt::format("{:<{}}  {:<9}", name_of(line), width, kind_name(line.row->kind));
    if (line.run.state != BudgetState::done) {
      text += fmt::format("{} {}: {}\n", start, state_word(line.run.state), line.run.reason);
      continue;
    }
    text += fmt::format("{} {:>10.2f} % {:>+10.0f} m\n", start, 100 * line.elsewhere,
                        line.numbers.run_out - table.own.run_out);
    for (const auto& [name, words] : line.run.accepted)
      text += fmt::format("{:<{}}  accepted: {}: {}\n", "", width, name.substr(name.find('.') + 1), words);
    for (const std::string& words : line.run.warnings) text += fmt::format("{:<{}}  warning: {}\n", "", width, words);
  }
  return text;
}

}  // namespace talus::postprocess
