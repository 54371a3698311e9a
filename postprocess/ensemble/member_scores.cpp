// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Footprints of members against the survey.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "common/gis/resampling.hpp"
#include "common/stage/in_threads.hpp"
#include "common/stage/stage.hpp"
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

/// The thickness of a member's deposit on the survey's grid [m]; 0 where the run's map ends, as the scores of a single
/// run have it.
std::vector<double> deposit_on_survey(const KeptThickness& deposit, const MapGrid& from, const MapGrid& to) {
  std::vector<double> thickness = on_grid({from, deposit.thickness(from.count())}, to);
  for (double& h : thickness)
    if (std::isnan(h)) h = 0;
  return thickness;
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
  const std::vector<double> none(counts.states.size(), nan);
  std::vector<RowColumn> flow{
      {ColumnKind::score, "footprint_csi", "1", "critical success index of the " + words, none, {}},
      {ColumnKind::score, "footprint_hit_rate", "1", "hit rate of the " + words, none, {}},
      {ColumnKind::score, "footprint_false_alarm_ratio", "1", "false alarms of the " + words, none, {}}};
  RowColumn of_deposit{
      ColumnKind::score, "deposit_csi", "1", "critical success index of the deposit's " + words, none, {}};
  const std::string against = fmt::format("the deposit's thickness against {}", survey.name);
  std::vector<RowColumn> of_thickness{
      {ColumnKind::score, "thickness_rmse_m", "m", "root mean square error of " + against, none, {}},
      {ColumnKind::score, "thickness_bias_m", "m", "mean error of " + against, none, {}}};
  const bool has_thickness = std::ranges::any_of(counts.deposit_thickness, [](const auto& one) { return one.kept(); });
  in_threads(counts.states.size(), "scoring the members", [&](std::size_t k) {
    if (counts.states[k] != MemberState::counted) return;
    if (!survey.footprint.empty()) {
      const Contingency here = compare(on_survey(counts.flow[k], counts.scene.grid, survey.grid), 0.5, survey.footprint,
                                       survey.footprint_threshold, area);
      flow[0].values[k] = here.csi();
      flow[1].values[k] = here.hit_rate();
      flow[2].values[k] = here.false_alarm_ratio();
    }
    if (!deposit.empty())
      of_deposit.values[k] =
          compare(on_survey(counts.deposit[k], counts.scene.grid, survey.grid), 0.5, deposit, deposit_threshold, area)
              .csi();
    if (!deposit.empty() && counts.deposit_thickness[k].kept()) {
      const ThicknessError error = thickness_error(
          deposit_on_survey(counts.deposit_thickness[k], counts.scene.grid, survey.grid), deposit, deposit_threshold);
      of_thickness[0].values[k] = error.rmse;
      of_thickness[1].values[k] = error.bias;
    }
  });
  std::vector<RowColumn> columns;
  if (!survey.footprint.empty()) columns = std::move(flow);
  if (!deposit.empty()) columns.push_back(std::move(of_deposit));
  if (!deposit.empty() && has_thickness)
    std::move(of_thickness.begin(), of_thickness.end(), std::back_inserter(columns));
  if (!deposit.empty() && !has_thickness)
    log_info("the members' deposits were not kept: no thickness_rmse_m ([ensemble] keep_deposits = true keeps them)");
  return columns;
}

}  // namespace talus::postprocess
