// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Footprints of members against the survey.
#include <fmt/format.h>

#include "common/gis/resampling.hpp"
#include "postprocess/ensemble/member_rows.hpp"
#include "postprocess/score/contingency.hpp"
#include "postprocess/survey/survey_grid.hpp"

namespace talus::postprocess {
namespace {

/// A footprint on the survey's grid, as the share of each cell that it covers; where the run's map ends, nothing.
std::vector<double> on_survey(const Footprint& footprint, const MapGrid& from, const MapGrid& to) {
  const std::vector<std::uint8_t> cells = cells_of(footprint, from.count());
  std::vector<double> share = on_grid({from, {cells.begin(), cells.end()}}, to);
  for (double& value : share)
    if (!(value > 0)) value = 0;
  return share;
}

/// The surveyed deposit where members' footprints can be compared with it.
std::vector<double> comparable_deposit(const Survey& survey, const EnsembleScene& scene) {
  std::vector<double> deposit = survey.deposit;
  if (!survey.deposit_is_change || deposit.empty()) return deposit;
  const std::vector<double> released = on_grid({scene.grid, scene.release_thickness}, survey.grid);
  for (std::size_t cell = 0; cell < deposit.size(); ++cell)
    if (released[cell] > 0) deposit[cell] = nan;
  return deposit;
}

}  // namespace

std::vector<RowColumn> member_scores(const Ensemble& ensemble, const Survey& survey, double deposit_threshold) {
  const EnsembleCounts& counts = ensemble.counts;
  const std::vector<double> deposit = comparable_deposit(survey, counts.scene);
  const std::string words =
      fmt::format("footprint (thicker than {:g} m) against {}", counts.scene.threshold, survey.name);
  const double area = survey.grid.cell * survey.grid.cell;
  std::vector<RowColumn> flow{
      {ColumnKind::score, "footprint_csi", "1", "critical success index of the " + words, {}, {}},
      {ColumnKind::score, "footprint_hit_rate", "1", "hit rate of the " + words, {}, {}},
      {ColumnKind::score, "footprint_false_alarm_ratio", "1", "false alarms of the " + words, {}, {}}};
  std::vector<RowColumn> of_deposit{
      {ColumnKind::score, "deposit_csi", "1", "critical success index of the deposit's " + words, {}, {}}};
  for (std::size_t k = 0; k < counts.states.size(); ++k) {
    stop_if_interrupted("scoring the members");
    const bool counted = counts.states[k] == MemberState::counted;
    Contingency here;
    if (counted && !survey.footprint.empty())
      here = compare(on_survey(counts.flow[k], counts.scene.grid, survey.grid), 0.5, survey.footprint,
                     survey.footprint_threshold, area);
    const bool scored = counted && !survey.footprint.empty();
    flow[0].values.push_back(scored ? here.csi() : nan);
    flow[1].values.push_back(scored ? here.hit_rate() : nan);
    flow[2].values.push_back(scored ? here.false_alarm_ratio() : nan);
    const bool lies = counted && !deposit.empty();
    of_deposit[0].values.push_back(lies ? compare(on_survey(counts.deposit[k], counts.scene.grid, survey.grid), 0.5,
                                                  deposit, deposit_threshold, area)
                                              .csi()
                                        : nan);
  }
  std::vector<RowColumn> columns;
  if (!survey.footprint.empty()) columns = std::move(flow);
  if (!deposit.empty()) columns.push_back(std::move(of_deposit[0]));
  return columns;
}

}  // namespace talus::postprocess
