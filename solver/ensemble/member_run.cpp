// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/member_run.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/map/statistics.hpp"
#include "common/run/mobility.hpp"
#include "common/stage/findings.hpp"
#include "common/stage/stage.hpp"
#include "solver/run/run_loop.hpp"
#include "solver/run/sanity.hpp"

namespace talus::solver {
namespace {

/// Thrown where the process was interrupted, and caught by run_member().
struct GivenUp {};

/// Keeps nothing of a run, and gives it up where the process is interrupted.
class MemberKeeper : public RunKeeper {
 public:
  void put_frame(double, std::int64_t) override {}
  void pass_whole_state(bool) override {}
  void pass_batch(const BatchReport&) override {
    if (interrupted()) throw GivenUp{};
  }
};

double largest_of(const std::vector<double>& values) {
  double largest = 0;
  for (const double value : values) largest = std::fmax(largest, value);
  return largest;
}

double area_above(const RunMaps& maps, const std::vector<double>& thickness, double threshold) {
  const auto covered = std::count_if(thickness.begin(), thickness.end(), [&](double h) { return h > threshold; });
  return static_cast<double>(covered) * maps.grid.cell * maps.grid.cell;
}

/// The outermost cells to which anything came.
std::int64_t cells_at_edge(const RunMaps& maps) {
  const MapGrid& grid = maps.grid;
  std::int64_t count = 0;
  for (int row = 0; row < grid.rows; ++row)
    for (int column = 0; column < grid.columns; ++column) {
      const bool edge = row == 0 || column == 0 || row == grid.rows - 1 || column == grid.columns - 1;
      if (edge && maps.peak_thickness[grid.index(column, row)] > 0) ++count;
    }
  return count;
}

}  // namespace

MemberResult measured(const RunMaps& maps, double threshold) {
  MemberResult result;
  if (const auto top = crown(maps, threshold)) {
    if (const auto toe = farthest(maps.grid, maps.deposit_thickness, threshold, *top, maps.before)) {
      result.run_out = plan_distance(*top, *toe);
      result.drop = top->z - toe->z;
      if (result.run_out > 0) result.reach_ratio = result.drop / result.run_out;
    }
    if (const auto edge = farthest(maps.grid, maps.peak_thickness, threshold, *top, maps.before))
      result.flow_reach = plan_distance(*top, *edge);
  }
  const auto start = centre_of_mass(maps.grid, maps.initial_thickness, maps.terrain),
             end = centre_of_mass(maps.grid, maps.deposit_thickness, maps.terrain);
  if (start && end) result.centre_travel = plan_distance(*start, *end);
  result.flow_area = area_above(maps, maps.peak_thickness, threshold);
  result.deposit_area = area_above(maps, maps.deposit_thickness, threshold);
  result.edge_cells = static_cast<double>(cells_at_edge(maps));
  result.largest_thickness = largest_of(maps.peak_thickness);
  result.p99_thickness = p99_of_positive(maps.peak_thickness);
  result.largest_deposit = largest_of(maps.deposit_thickness);
  result.p99_deposit = p99_of_positive(maps.deposit_thickness);
  result.largest_speed = largest_of(maps.peak_speed);
  result.p99_speed = p99_of_positive(maps.peak_speed);
  result.largest_pressure = largest_of(maps.peak_pressure_kPa);
  result.p99_pressure = p99_of_positive(maps.peak_pressure_kPa);
  return result;
}

std::optional<MemberRun> run_member(const std::shared_ptr<const Plan>& plan, const AnyDevice& device) {
  const Findings found("solve", plan->options.accept);
  for (const Finding& finding : plan->findings)
    if (finding.severity == Severity::refusal) add_finding(finding);
  RunTimer timer;
  RunLoop loop(plan, device, HistoryUse::judged);
  loop.start();
  MemberKeeper keeper;
  try {
    loop.step_to_end(keeper, true);
  } catch (const GivenUp&) {
    return std::nullopt;
  }
  const SolverState state = loop.stepper().solver().state();
  const RunEnd end = loop.end(state);
  const double outflow = loop.memory().outflow_volume;
  loop.history().conclude();
  say_sanity(sanity_of(end, loop.history().rows(), outflow));
  MemberRun run;
  run.maps = final_maps(end, loop.stepper().solver().thickness());
  run.result = measured(run.maps, plan->options.map_threshold);
  const SlideVolumes volumes = slide_volumes(end, outflow);
  run.result.volume_released = volumes.released;
  run.result.volume_final = volumes.final;
  run.result.volume_outflow = outflow;
  run.result.time_end = loop.stepper().time();
  run.result.steps = static_cast<double>(state.clock.step);
  run.result.wall_time = timer.seconds();
  return run;
}

}  // namespace talus::solver
