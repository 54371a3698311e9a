// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "common/ensemble/options.hpp"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <set>

#include <fmt/format.h>

namespace talus {
namespace {

std::vector<std::string_view> names_of_rows() {
  std::vector<std::string_view> names;
  for (const BudgetRow& row : budget_rows)
    if (!std::string_view(row.name).starts_with("own")) names.emplace_back(row.name);
  return names;
}

}  // namespace

const BudgetRow* find_budget_row(std::string_view name) {
  const auto* found =
      std::ranges::find(budget_rows, name, [](const BudgetRow& row) { return std::string_view(row.name); });
  return found == std::end(budget_rows) ? nullptr : found;
}

void OwnChange::describe(recipe::Visitor& v) {
  v.text("name", name, "what the table calls the run: letters, digits and dashes");
  const bool fits = !name.empty() && std::all_of(name.begin(), name.end(), [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '-' || c == '_';
  });
  v.needs(fits, {fmt::format("[[ensemble.budget.run]] name = \"{}\"", name), "it stands in tables and files",
                 "Use letters, digits, '-' and '_'"});
  recipe::choice(v, "kind", kind, {{"physical", BudgetKind::physical}, {"numerical", BudgetKind::numerical}},
                 "whether the doubt is about the slide or about the computation");
  v.names("set", set, {}, "what is other, as for --set: [\"solve.base.friction_angle_deg=20\"]");
  v.needs(!set.empty(), {fmt::format("[[ensemble.budget.run]] \"{}\" sets nothing", name), "the run would be the same",
                         "Add set = [\"solve. ...=...\"]"});
}

void BudgetOptions::describe(recipe::Visitor& v) {
  v.names("leave_out", leave_out, names_of_rows(), "rows that are not made");
  v.number("cell_factor", cell_factor, recipe::Range{0.1, 10}, "row cells: sides of the other cells over the run's");
  v.needs(cell_factor != 1, {"[ensemble.budget] cell_factor = 1", "the other run would be the same",
                             "Give another factor, or leave the row out with leave_out"});
  v.number("friction_doubt", friction_doubt, recipe::Range{0, 1, true, true},
           "rows friction and strength: share by which a coefficient of friction, of an angle its tangent, may be "
           "wrong, either way");
  v.number("drag_doubt", drag_doubt, recipe::Range{0, 1, true, true},
           "row drag: share by which the drag of the bed may be wrong, either way");
  v.integer("survey_draws", survey_draws, {1, 100},
            "row survey: members, each with another error of [ensemble.elevation_error]; nothing there: as the surveys "
            "show it on stable ground");
  recipe::list(v, "run", changes, "a member of your own, with other values of [solve]");
}

void BudgetOptions::check(std::vector<Fault>& faults) const {
  const std::vector<BudgetMember> members = budget_members(*this);
  if (members.size() == 1)
    faults.push_back(
        {"[ensemble.budget] leave_out names all rows", "nothing would be left to run", "Leave one of them in"});
  std::set<std::string> names;
  for (const BudgetMember& member : members)
    if (!names.insert(member.name).second)
      faults.push_back({fmt::format("[[ensemble.budget.run]] \"{}\" is there twice", member.name),
                        "the table could not tell the runs apart", "Give one of them another name"});
}

bool BudgetOptions::has(std::string_view row) const {
  return std::find(leave_out.begin(), leave_out.end(), row) == leave_out.end();
}

std::vector<BudgetMember> budget_members(const BudgetOptions& options) {
  std::vector<BudgetMember> members{{"recipe", ""}};
  for (const BudgetRow& row : budget_rows) {
    const std::string name = row.name;
    if (name.starts_with("own") || !options.has(name)) continue;
    for (int draw = 1; draw <= options.survey_draws && name == survey_row; ++draw)
      members.push_back({fmt::format("{}-{}", name, draw), name});
    if (name != survey_row) members.push_back({name + std::string(row.one), name});
    if (!row.other.empty()) members.push_back({name + std::string(row.other), name});
  }
  for (const OwnChange& change : options.changes)
    members.push_back({change.name, change.kind == BudgetKind::physical ? "own" : "own-numerical"});
  return members;
}

}  // namespace talus
