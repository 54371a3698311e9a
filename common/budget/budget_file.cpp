// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Writing and reading budget.h5. Layout: attributes of / = whose budget it is; /runs/NN = a run: words, state, numbers,
// and the maps of one that is done; /provenance.
#include <algorithm>
#include <iterator>
#include <sstream>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "common/budget/budget.hpp"
#include "common/ensemble/ensemble_file.hpp"
#include "common/run/check_values.hpp"
#include "common/run/grid_attributes.hpp"

namespace talus {
namespace {

const EnsembleFileKind budget_kind{{"talus budget", "an error budget"}, "Run talus-solve --budget again"};

constexpr const char* state_names[] = {"waiting", "done", "failed", "left out"};

void write_map_of(h5::File& file, const std::string& path, const Raster& map) {
  file.write<double>(path, {map.values.size()}, map.values);
  file.set_text(path, "unit", "m");
}

Raster read_map_of(const h5::File& file, const std::string& path, const MapGrid& grid) {
  Raster map{grid, file.read<double>(path, {static_cast<hsize_t>(grid.count())})};
  h5::check_values<double>(file, path, map.values, h5::not_negative_or_none);
  return map;
}

void write_run_of(h5::File& file, const std::string& group, const BudgetRun& run) {
  file.make_group(group);
  file.set_text(group, "name", run.name);
  file.set_text(group, "row", run.row);
  file.set_text(group, "words", run.words);
  file.set_text(group, "values", fmt::format("{}", fmt::join(run.values, "\n")));
  file.set_text(group, "domain", run.domain);
  file.set_text(group, "state", state_names[static_cast<std::size_t>(run.state)]);
  file.set_text(group, "reason", run.reason);
  if (!run.accepted.empty()) h5::write_facts(file, group + "/accepted", run.accepted);
  if (!run.warnings.empty()) file.set_text(group, "warnings", fmt::format("{}", fmt::join(run.warnings, "\n")));
  if (run.state != BudgetState::done) return;
  for (const ResultNumber& number : result_numbers) file.set_number(group, number.name, run.result.*(number.value));
  h5::write_grid(file, group, run.deposit.grid);
  write_map_of(file, group + "/deposit_thickness", run.deposit);
  write_map_of(file, group + "/peak_thickness", run.peak_thickness);
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream words(text);
  for (std::string line; std::getline(words, line);) lines.push_back(line);
  return lines;
}

BudgetState state_called(const h5::File& file, const std::string& group) {
  const std::string name = file.text(group, "state");
  const auto* found = std::find(std::begin(state_names), std::end(state_names), name);
  if (found == std::end(state_names))
    file.refuse(fmt::format("attribute {} state is \"{}\"", group, name), "there is no such state");
  return static_cast<BudgetState>(found - std::begin(state_names));
}

BudgetRun read_run_of(const h5::File& file, const std::string& group) {
  BudgetRun run{.name = file.text(group, "name"),
                .row = file.text(group, "row"),
                .words = file.text(group, "words"),
                .values = {},
                .domain = file.text(group, "domain"),
                .state = state_called(file, group),
                .reason = file.text(group, "reason")};
  if (find_budget_row(run.row) == nullptr)
    file.refuse(fmt::format("attribute {} row is \"{}\"", group, run.row), "a budget has no such row");
  run.values = lines_of(file.text(group, "values"));
  if (file.has_attribute(group, "warnings")) run.warnings = lines_of(file.text(group, "warnings"));
  if (file.exists(group + "/accepted")) run.accepted = h5::read_facts(file, group + "/accepted");
  if (run.state != BudgetState::done) return run;
  for (const ResultNumber& number : result_numbers)
    run.result.*(number.value) = h5::checked_number(file, group, number.name, h5::finite_or_none);
  const MapGrid grid = h5::read_grid(file, group);
  run.deposit = read_map_of(file, group + "/deposit_thickness", grid);
  run.peak_thickness = read_map_of(file, group + "/peak_thickness", grid);
  return run;
}

}  // namespace

std::string survey_draw_name(int draw) { return fmt::format("survey-{}", draw); }

std::size_t Budget::count(BudgetState state) const {
  return static_cast<std::size_t>(
      std::count_if(runs.begin(), runs.end(), [&](const BudgetRun& one) { return one.state == state; }));
}

void write_budget(const std::filesystem::path& path, const Budget& budget) {
  write_ensemble_file(path, budget_kind, [&](h5::File& file) {
    file.set_text("/", "fingerprint", budget.fingerprint);
    file.set_text("/", "run", budget.run);
    file.set_text("/", "options", budget.options);
    file.make_group("/runs");
    for (std::size_t n = 0; n < budget.runs.size(); ++n)
      write_run_of(file, fmt::format("/runs/{:02}", n), budget.runs[n]);
    h5::write_facts(file, "/provenance", budget.provenance);
  });
}

Budget read_budget(const std::filesystem::path& path) {
  const h5::File file = open_ensemble_file(path, budget_kind);
  Budget budget{.fingerprint = file.text("/", "fingerprint"),
                .run = file.text("/", "run"),
                .options = file.text("/", "options"),
                .runs = {},
                .provenance = h5::read_facts(file, "/provenance")};
  for (const std::string& name : file.children("/runs")) budget.runs.push_back(read_run_of(file, "/runs/" + name));
  return budget;
}

}  // namespace talus
