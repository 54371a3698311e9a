// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The error budget of the report.
#include <cmath>

#include "common/stage/acceptance.hpp"
#include "postprocess/budget/budget_table.hpp"
#include "postprocess/report/parts.hpp"

namespace talus::postprocess {
namespace {

Json finite_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json budget_line_json(const BudgetLine& line) {
  Json json{{"name", line.run.name},
            {"kind", kind_name(line.row->kind)},
            {"title", line.row->title},
            {"words", line.run.words},
            {"done", line.run.state == BudgetState::done},
            {"failed", line.run.state == BudgetState::failed},
            {"reason", line.run.reason},
            {"values", line.run.values},
            {"accepted", accepted_line(line.run.accepted)},
            {"warnings", line.run.warnings},
            {"elsewhere", finite_or_null(line.elsewhere)},
            {"overlap", finite_or_null(line.overlap)},
            {"run_out", finite_or_null(line.numbers.run_out)},
            {"speed", finite_or_null(line.numbers.largest_speed)},
            {"volume", finite_or_null(line.numbers.volume)},
            {"steps", finite_or_null(line.numbers.steps)},
            {"seconds", finite_or_null(line.numbers.wall_time)}};
  json["scores"] = Json::array();
  for (const double score : line.scores) json["scores"].push_back(finite_or_null(score));
  return json;
}

}  // namespace

Json budget_json(const ReportInput& input) {
  if (input.budget == nullptr) return nullptr;
  const BudgetTable& table = *input.budget;
  Json json{{"run_out", finite_or_null(table.own.run_out)},
            {"speed", finite_or_null(table.own.largest_speed)},
            {"volume", finite_or_null(table.own.volume)},
            {"steps", finite_or_null(table.own.steps)},
            {"seconds", finite_or_null(table.own.wall_time)}};
  json["scores"] = Json::array();
  for (const BudgetScore& score : table.scores)
    json["scores"].push_back({{"key", score.key},
                              {"label", score.label},
                              {"unit", score.unit},
                              {"decimals", score.decimals},
                              {"own", finite_or_null(score.own)}});
  json["lines"] = Json::array();
  for (const BudgetLine& line : table.lines) json["lines"].push_back(budget_line_json(line));
  return json;
}

}  // namespace talus::postprocess
