// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/ensemble/budget_table.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/ensemble/counts.hpp"
#include "common/stage/findings.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/score/contingency.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {
namespace {

constexpr std::size_t itself = 0;  ///< the place of the recipe itself among the members

double overlap_of(const Footprint& one, const Footprint& other, std::size_t count) {
  const std::vector<std::uint8_t> a = cells_of(one, count), b = cells_of(other, count);
  double both = 0, either = 0;
  for (std::size_t i = 0; i < count; ++i) {
    both += a[i] != 0 && b[i] != 0 ? 1 : 0;
    either += a[i] != 0 || b[i] != 0 ? 1 : 0;
  }
  return either > 0 ? both / either : nan;
}

/// Compares members one after another with the recipe itself.
class BudgetComparison {
 public:
  BudgetComparison(const Ensemble& ensemble, const MemberRows& rows, const Options& options)
      : ensemble_(ensemble), counts_(ensemble.counts), rows_(rows), options_(options), maps_(base_maps(counts_.scene)) {
    if (counts_.states.at(itself) != MemberState::counted)
      throw DataError({fmt::format("{}: the recipe itself is not counted", ensemble.files.at(1).string()),
                       rows.failures[itself].empty() ? "its run is still to be made" : rows.failures[itself],
                       "Its members are compared with it: mend the recipe, and run talus-solve again"});
    maps_.deposit_thickness = counts_.deposit_thickness[itself].thickness(maps_.grid.count());
  }

  BudgetTable table() {
    BudgetTable table{
        .own = line_of(itself), .threshold = counts_.scene.threshold, .scores = {}, .lines = {}, .spreads = {}};
    for (const RowColumn& column : rows_.columns)
      if (column.kind == ColumnKind::score) table.scores.push_back(column.name);
    for (std::size_t k = 1; k < counts_.states.size(); ++k) {
      stop_if_interrupted("comparing the members of the budget");
      const bool applies = counts_.states[k] != MemberState::left_out || !rows_.failures[k].empty();
      if (applies) table.lines.push_back(line_of(k));
    }
    std::stable_sort(table.lines.begin(), table.lines.end(),
                     [](const BudgetLine& a, const BudgetLine& b) { return size_of(a) > size_of(b); });
    const BudgetKind physical = BudgetKind::physical, numerical = BudgetKind::numerical;
    add_spread(table, "deposit_spread", "all doubts", nullptr);
    add_spread(table, "deposit_spread_physical", "doubts about the slide", &physical);
    add_spread(table, "deposit_spread_numerical", "doubts about the computation", &numerical);
    return table;
  }

 private:
  static double size_of(const BudgetLine& line) {
    if (line.state == MemberState::counted) return std::isfinite(line.elsewhere) ? line.elsewhere : 0;
    return line.state == MemberState::failed ? -1.0 : -2.0;
  }

  BudgetLine line_of(std::size_t k) {
    BudgetLine line{.name = ensemble_.table.names.at(k), .row = find_budget_row(ensemble_.table.rows.at(k))};
    line.state = counts_.states[k];
    line.reason = rows_.failures[k];
    line.warnings = rows_.warnings[k];
    for (const MemberWords& change : counts_.changes) {
      std::istringstream words(change.member == static_cast<std::int64_t>(k) ? change.words : "");
      for (std::string text; std::getline(words, text);)
        line.words.empty() ? line.words = text : line.values.emplace_back(text);
    }
    if (line.state != MemberState::counted) return line;
    line.result = counts_.results[k];
    for (const RowColumn& column : rows_.columns)
      if (column.kind == ColumnKind::score) line.scores.push_back(column.values[k]);
    compare(line, k);
    return line;
  }

  void compare(BudgetLine& line, std::size_t k) {
    RunMaps other;
    other.grid = counts_.grid_of(static_cast<std::int64_t>(k));
    other.deposit_thickness = counts_.deposit_thickness[k].thickness(other.grid.count());
    // In the coarser cells of the two: what only the finer ones can show is no doubt about the flow.
    const bool coarser = other.grid.cell > maps_.grid.cell;
    const DepositDifference difference =
        deposit_difference(coarser ? other : maps_, coarser ? maps_ : other, options_.deposit_threshold);
    line.elsewhere = difference.moved;
    line.largest_change = std::max(difference.larger, difference.smaller);
    line.p99_change = difference.p99;
    line.overlap = overlap_of(counts_.flow[itself], counts_.flow[k], maps_.grid.count());
    std::vector<double> deposit = on_grid({other.grid, std::move(other.deposit_thickness)}, maps_.grid);
    for (double& value : deposit)
      if (!(value > 0)) value = 0;
    line.volume = volume_under(deposit, maps_.grid.cell);
    deposits_.emplace_back(line.row, std::move(deposit));
  }

  /// Over the recipe itself and the members of a kind (null: all); no map where there are none.
  void add_spread(BudgetTable& table, const char* name, const char* over, const BudgetKind* kind) const {
    std::vector<double> lower = deposits_.front().second, upper = lower;
    bool any = false;
    for (const auto& [row, deposit] : deposits_) {
      if (row == nullptr || (kind != nullptr && row->kind != *kind)) continue;
      any = true;
      for (std::size_t i = 0; i < deposit.size(); ++i) {
        lower[i] = std::min(lower[i], deposit[i]);
        upper[i] = std::max(upper[i], deposit[i]);
      }
    }
    for (std::size_t i = 0; i < upper.size(); ++i) upper[i] -= lower[i];
    if (any) table.spreads.push_back({name, over, values_raster(maps_, upper, true)});
  }

  const Ensemble& ensemble_;
  const EnsembleCounts& counts_;
  const MemberRows& rows_;
  const Options& options_;
  RunMaps maps_;                                                            ///< the recipe's own deposit, on its ground
  std::vector<std::pair<const BudgetRow*, std::vector<double>>> deposits_;  ///< on its grid; its own is the first
};

using OrderedJson = nlohmann::ordered_json;

const char* kind_name(BudgetKind kind) { return kind == BudgetKind::numerical ? "numerical" : "physical"; }

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

BudgetTable budget_table(const Ensemble& ensemble, const MemberRows& rows, const Options& options) {
  return BudgetComparison(ensemble, rows, options).table();
}

void warn_of_chaos(const BudgetTable& table) {
  constexpr double repeatable = 0.02;  // of the deposit
  for (const BudgetLine& line : table.lines) {
    if (line.row == nullptr || line.row->name != repeat_row || !(line.elsewhere > repeatable)) continue;
    warn("chaotic-flow",
         fmt::format("the flow is chaotic: in a run that differs in its last digits {:.2g} % of the deposit lies "
                     "elsewhere. No finer steps tell more. Where single cells matter, read budget/deposit_spread.tif",
                     100 * line.elsewhere),
         {{"deposit_elsewhere", line.elsewhere, "1"}});
  }
}

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
  std::string text = fmt::format("{:<{}}  {:<9} {:>12} {:>12}\n", "error budget", width, "kind", "elsewhere",
                                 fmt::format("L > {:g} m", table.threshold));
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
