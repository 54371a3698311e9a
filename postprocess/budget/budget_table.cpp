// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "postprocess/budget/budget_table.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <fmt/format.h>

#include "common/gis/resampling.hpp"
#include "common/map/statistics.hpp"
#include "common/run/mobility.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/identity.hpp"
#include "common/stage/stage.hpp"
#include "postprocess/fields/fields.hpp"
#include "postprocess/score/deposit_difference.hpp"
#include "postprocess/survey/survey_grid.hpp"

namespace talus::postprocess {
namespace {

/// Scores that the table shows, where the survey gives them.
constexpr const char* shown_scores[] = {"footprint_csi", "deposit_csi", "thickness_rmse_m", "thickness_bias_m",
                                        "deposit_volume_ratio"};

/// A thickness on the grid of the run, without holes.
std::vector<double> thickness_on(const MapGrid& grid, const Raster& map) {
  std::vector<double> values = same_grid(map.grid, grid) ? map.values : resample_thickness(map, grid).values;
  for (double& value : values)
    if (!(value > 0)) value = 0;
  return values;
}

double run_out_of(const RunMaps& maps) {
  const auto top = crown(maps, maps.threshold);
  if (!top) return nan;
  const auto toe = farthest(maps.grid, maps.deposit_thickness, maps.threshold, *top, maps.before);
  return toe ? plan_distance(*top, *toe) : nan;
}

BudgetNumbers numbers_of(const Run& run) {
  double speed = 0;
  for (const double v : run.maps.peak_speed) speed = std::fmax(speed, v);
  return {.run_out = run_out_of(run.maps),
          .largest_speed = speed,
          .p99_speed = p99_of_positive(run.maps.peak_speed),
          .volume = volume_under(run.maps.deposit_thickness, run.maps.grid.cell),
          .steps = static_cast<double>(run.summary.steps),
          .wall_time = run.summary.wall_time};
}

double overlap_of(const std::vector<double>& a, const std::vector<double>& b, double threshold) {
  double both = 0, either = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const bool here = a[i] > threshold, there = b[i] > threshold;
    both += here && there ? 1 : 0;
    either += here || there ? 1 : 0;
  }
  return either > 0 ? both / either : nan;
}

/// Compares runs one after another with the run itself.
class BudgetComparison {
 public:
  explicit BudgetComparison(const BudgetReference& reference)
      : reference_(reference), options_(reference.options), grid_(reference.run.maps.grid) {
    options_.survey.resamples = 0;  // no row needs the error of a score
    lower_ = upper_ = thickness_on(grid_, {grid_, reference.run.maps.deposit_thickness});
  }

  BudgetTable table(Budget&& budget) {
    BudgetTable table{.own = numbers_of(reference_.run),
                      .scores = {},
                      .lines = {},
                      .options = budget.options,
                      .spread = {},
                      .spread_numerical = {},
                      .spread_physical = {}};
    if (reference_.survey) table.scores = own_scores();
    for (BudgetRun& run : budget.runs) {
      stop_if_interrupted("comparing the runs of the budget");
      table.lines.push_back(line_of(std::move(run), table.scores));
    }
    sort(table.lines);
    table.spread = spread_of(nullptr);
    const BudgetKind numerical = BudgetKind::numerical, physical = BudgetKind::physical;
    if (table.compared(numerical) > 0) table.spread_numerical = spread_of(&numerical);
    if (table.compared(physical) > 0) table.spread_physical = spread_of(&physical);
    return table;
  }

 private:
  std::vector<BudgetScore> own_scores() const {
    std::vector<BudgetScore> scores;
    const Score score =
        make_score(scored_run(reference_.run.maps.deposit_thickness, reference_.run.maps.peak_thickness), options_,
                   reference_.survey, reference_.thalweg);
    for (const ScoreSection& section : score.sections)
      for (const ScoreEntry& entry : section.entries) {
        const auto* value = std::get_if<double>(&entry.value);
        const bool is_shown =
            std::find(std::begin(shown_scores), std::end(shown_scores), entry.key) != std::end(shown_scores);
        if (is_shown && value != nullptr)
          scores.push_back({entry.key, entry.label, entry.unit, entry.decimals, *value});
      }
    return scores;
  }

  /// The run itself with another deposit and footprint, without what no score looks at.
  Run scored_run(std::vector<double> deposit, std::vector<double> peak) const {
    Run other;
    other.summary = reference_.run.summary;
    other.history = reference_.run.history;
    other.maps = reference_.run.maps;
    other.maps.deposit_thickness = std::move(deposit);
    other.maps.peak_thickness = std::move(peak);
    return other;
  }

  BudgetLine line_of(BudgetRun&& run, const std::vector<BudgetScore>& scores) {
    BudgetLine line{.run = std::move(run), .row = nullptr};
    line.row = find_budget_row(line.run.row);
    if (line.run.state == BudgetState::done) compare_with(line, scores);
    line.run.deposit = line.run.peak_thickness = {};
    return line;
  }

  void compare_with(BudgetLine& line, const std::vector<BudgetScore>& scores) {
    const RunMaps& maps = reference_.run.maps;
    RunMaps other;
    other.grid = line.run.deposit.grid;
    other.deposit_thickness = line.run.deposit.values;
    // In the coarser cells of the two: what only the finer ones can show is no doubt about the flow.
    const bool coarser = other.grid.cell > grid_.cell;
    const DepositDifference difference =
        deposit_difference(coarser ? other : maps, coarser ? maps : other, options_.deposit_threshold);
    const std::vector<double> deposit = thickness_on(grid_, line.run.deposit),
                              peak = thickness_on(grid_, line.run.peak_thickness);
    line.elsewhere = difference.moved;
    line.largest_change = std::max(difference.larger, difference.smaller);
    line.p99_change = difference.p99;
    line.overlap = overlap_of(maps.peak_thickness, peak, options_.footprint_threshold);
    line.numbers = {.run_out = line.run.result.run_out,
                    .largest_speed = line.run.result.largest_speed,
                    .p99_speed = line.run.result.p99_speed,
                    .volume = volume_under(deposit, grid_.cell),
                    .steps = line.run.result.steps,
                    .wall_time = line.run.result.wall_time};
    deposits_.emplace_back(line.row->kind, deposit);
    if (scores.empty()) return;
    const Score score = make_score(scored_run(deposit, peak), options_, reference_.survey, reference_.thalweg);
    for (const BudgetScore& own : scores) line.scores.push_back(score.number(own.key).value_or(nan));
  }

  static void sort(std::vector<BudgetLine>& lines) {
    const auto size = [](const BudgetLine& line) {
      if (line.run.state == BudgetState::done) return std::isfinite(line.elsewhere) ? line.elsewhere : 0;
      return line.run.state == BudgetState::failed ? -1.0 : -2.0;
    };
    std::stable_sort(lines.begin(), lines.end(),
                     [&](const BudgetLine& a, const BudgetLine& b) { return size(a) > size(b); });
  }

  /// Largest less smallest thickness over the run and those of a kind (null: all).
  Raster spread_of(const BudgetKind* kind) const {
    std::vector<double> lower = lower_, upper = upper_;
    for (const auto& [of, deposit] : deposits_) {
      if (kind != nullptr && of != *kind) continue;
      for (std::size_t i = 0; i < deposit.size(); ++i) {
        lower[i] = std::min(lower[i], deposit[i]);
        upper[i] = std::max(upper[i], deposit[i]);
      }
    }
    for (std::size_t i = 0; i < upper.size(); ++i) upper[i] -= lower[i];
    return values_raster(reference_.run.maps, upper, true);
  }

  const BudgetReference& reference_;
  Options options_;
  const MapGrid& grid_;
  std::vector<double> lower_, upper_;
  std::vector<std::pair<BudgetKind, std::vector<double>>> deposits_;
};

}  // namespace

std::size_t BudgetTable::compared(BudgetKind kind) const {
  return static_cast<std::size_t>(std::count_if(lines.begin(), lines.end(), [&](const BudgetLine& line) {
    return line.run.state == BudgetState::done && line.row->kind == kind;
  }));
}

const char* kind_name(BudgetKind kind) { return kind == BudgetKind::numerical ? "numerical" : "physical"; }

std::optional<BudgetTable> budget_table(const std::filesystem::path& file, const BudgetReference& reference) {
  if (!std::filesystem::exists(file)) return std::nullopt;
  Budget budget = read_budget(file);
  const std::string own = fact(reference.run.summary.provenance, run_id);
  if (budget.run != own) {
    warn("budget-of-another-run",
         fmt::format("{}: it is the budget of another run than {}; it is left out. talus-solve --budget makes "
                     "one of this run",
                     file.string(), own));
    return std::nullopt;
  }
  return BudgetComparison(reference).table(std::move(budget));
}

}  // namespace talus::postprocess
