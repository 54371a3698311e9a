// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Footprints of members against the survey.
#include <algorithm>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "common/ensemble/footprint.hpp"
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

/// The scores of all members against one survey, one column each.
class Scores {
 public:
  Scores(const EnsembleCounts& counts, const Survey& survey, double deposit_threshold);
  /// Writes the scores of member k; different members may be scored at the same time.
  void score(std::size_t k);
  /// The columns that have something to compare with.
  std::vector<RowColumn> columns();

 private:
  const EnsembleCounts& counts_;
  const Survey& survey_;
  std::vector<double> surveyed_deposit_;
  double deposit_threshold_;
  double cell_area_;
  std::vector<RowColumn> flow_;       // overlap of the footprint of the flow
  std::vector<RowColumn> deposit_;    // overlap of the footprint of the deposit
  std::vector<RowColumn> thickness_;  // errors of the deposit's thickness
};

Scores::Scores(const EnsembleCounts& counts, const Survey& survey, double deposit_threshold)
    : counts_(counts),
      survey_(survey),
      surveyed_deposit_(comparable_deposit(survey, counts.scene)),
      deposit_threshold_(deposit_threshold),
      cell_area_(survey.grid.cell * survey.grid.cell) {
  const std::string footprint =
      fmt::format("footprint (thicker than {:g} m) against {}", counts.scene.threshold, survey.name);
  const std::string thickness = fmt::format("the deposit's thickness against {}", survey.name);
  const std::vector<double> none(counts.states.size(), nan);
  flow_ = {{ColumnKind::score, "footprint_csi", "1", "critical success index of the " + footprint, none, {}},
           {ColumnKind::score, "footprint_hit_rate", "1", "hit rate of the " + footprint, none, {}},
           {ColumnKind::score, "footprint_false_alarm_ratio", "1", "false alarms of the " + footprint, none, {}}};
  deposit_ = {
      {ColumnKind::score, "deposit_csi", "1", "critical success index of the deposit's " + footprint, none, {}}};
  thickness_ = {{ColumnKind::score, "thickness_rmse_m", "m", "root mean square error of " + thickness, none, {}},
                {ColumnKind::score, "thickness_bias_m", "m", "mean error of " + thickness, none, {}}};
}

void Scores::score(std::size_t k) {
  const MapGrid& from = counts_.scene.grid;
  const MapGrid& to = survey_.grid;
  if (!survey_.footprint.empty()) {
    const Contingency here =
        compare(on_survey(counts_.flow[k], from, to), 0.5, survey_.footprint, survey_.footprint_threshold, cell_area_);
    flow_[0].values[k] = here.csi();
    flow_[1].values[k] = here.hit_rate();
    flow_[2].values[k] = here.false_alarm_ratio();
  }
  if (surveyed_deposit_.empty()) return;
  deposit_[0].values[k] =
      compare(on_survey(counts_.deposit[k], from, to), 0.5, surveyed_deposit_, deposit_threshold_, cell_area_).csi();
  if (!counts_.deposit_thickness[k].kept()) return;
  const ThicknessError error = thickness_error(
      deposit_on_survey(counts_.deposit_thickness[k], counts_.grid_of(static_cast<std::int64_t>(k)), to),
      surveyed_deposit_, deposit_threshold_);
  thickness_[0].values[k] = error.rmse;
  thickness_[1].values[k] = error.bias;
}

std::vector<RowColumn> Scores::columns() {
  std::vector<RowColumn> columns;
  const auto add = [&](std::vector<RowColumn>& more) { std::ranges::move(more, std::back_inserter(columns)); };
  if (!survey_.footprint.empty()) add(flow_);
  if (surveyed_deposit_.empty()) return columns;
  add(deposit_);
  if (std::ranges::any_of(counts_.deposit_thickness, [](const KeptThickness& one) { return one.kept(); }))
    add(thickness_);
  else
    log_info("the members' deposits were not kept: no thickness_rmse_m ([ensemble] keep = [\"deposits\"] keeps them)");
  return columns;
}

}  // namespace

std::vector<RowColumn> member_scores(const Ensemble& ensemble, const Survey& survey, double deposit_threshold) {
  const EnsembleCounts& counts = ensemble.counts;
  Scores scores(counts, survey, deposit_threshold);
  in_threads(counts.states.size(), "scoring the members", [&](std::size_t k) {
    if (counts.states[k] == MemberState::counted) scores.score(k);
  });
  return scores.columns();
}

}  // namespace talus::postprocess
