// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/ensemble/run_members.hpp"

#include <algorithm>
#include <cmath>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include "common/map/statistics.hpp"
#include "common/run/mobility.hpp"
#include "common/run/run_file.hpp"
#include "common/stage/findings.hpp"
#include "solver/ensemble/in_flight.hpp"
#include "solver/run/recorders/history.hpp"
#include "solver/run/run_stage.hpp"

namespace talus::solver {
namespace {

/// Thrown where the process was interrupted, and caught by run_member().
struct GivenUp {};

/// Keeps nothing of a run, and gives it up where the process is interrupted.
class MemberKeeper : public RunKeeper {
 public:
  void put_frame(double) override {}
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

/// The numbers of a member at its gauges, in whose cell the maps are read.
std::map<std::string, double> measured_at(const std::vector<GaugeOptions>& gauges, const RunMaps& maps) {
  std::map<std::string, double> numbers;
  for (const GaugeOptions& gauge : gauges) {
    const auto [x, y] = in_cells(maps.grid, gauge.x, gauge.y);
    const int column = static_cast<int>(std::lround(x)), row = static_cast<int>(std::lround(y));
    for (const GaugeNumber& number : gauge_numbers)
      numbers[prefix_of("gauge", gauge.name) + number.name] =
          maps.grid.holds(column, row) ? (maps.*number.values)[maps.grid.index(column, row)] : nan;
  }
  return numbers;
}

/// What a killed process may lose [s]. What is finished is saved after the first member, so that a folder that takes
/// no files shows at once, and then so often: writing the counts of a large map takes seconds.
constexpr double save_interval = 60;

/// What a member's run came to: maps and numbers, or why it failed; neither where it was given up.
struct Outcome {
  std::optional<MemberRun> run;
  std::string failure;
  std::vector<Finding> findings;
};

constexpr const char* at_the_edge =
    "it came to the edge of its domain, and what lies beyond is not known ([slides] at_edge = \"fail\"). Give a larger "
    "margin_m, or a smaller reach_angle_deg";

Outcome outcome_of(const Members& members, std::int64_t member, const AnyDevice& device, bool edge_fails) {
  const Findings found("solve", {}, Findings::Log::kept_back);
  Outcome outcome;
  outcome.failure = failure_of([&] { outcome.run = run_member(members.plan(member), device); });
  if (edge_fails && outcome.run && is_at_edge(outcome.run->result)) {
    outcome.run.reset();
    outcome.failure = at_the_edge;
  }
  outcome.findings = found.list();
  return outcome;
}

std::vector<std::int64_t> waiting_in(const EnsembleCounts& counts) {
  std::vector<std::int64_t> waiting;
  for (std::int64_t k = counts.part.first; k < counts.part.end; ++k)
    if (counts.state_of(k) == MemberState::waiting) waiting.push_back(k);
  return waiting;
}

/// What the threads share: the counts, and what is said.
class Tallying {
 public:
  Tallying(EnsembleCounts& counts, std::size_t members, const MembersPlan& plan)
      : counts_(counts), members_(members), plan_(plan) {}

  void count(std::int64_t member, Outcome&& outcome) {
    const std::lock_guard<std::mutex> one(mutex_);
    if (outcome.run)
      counts_.add(member, outcome.run->maps, outcome.run->result);
    else if (!outcome.failure.empty())
      counts_.fail(member, std::move(outcome.failure));
    else
      return;  // given up
    for (Finding& finding : outcome.findings) counts_.add_finding(member, std::move(finding));
    ++done_;
    say();
    save();
  }

  bool is_whole() const { return done_ == members_; }

 private:
  void say() {
    if (!progress_.due()) return;
    const double wall = timer_.seconds(),
                 left = wall / static_cast<double>(done_) * static_cast<double>(members_ - done_);
    const std::int64_t failed = counts_.count(MemberState::failed);
    progress_.update(fmt::format("member {}/{}  {:.2g} s each  eta {:.0f} s{}", done_, members_,
                                 wall / static_cast<double>(done_), left,
                                 failed > 0 ? fmt::format("  {} failed", failed) : ""));
  }

  void save() {
    if (!plan_.save || (saved_ && timer_.seconds() - *saved_ < save_interval) || done_ == members_) return;
    plan_.save();
    saved_ = timer_.seconds();
  }

  EnsembleCounts& counts_;
  std::size_t members_, done_ = 0;
  const MembersPlan& plan_;
  std::mutex mutex_;
  Progress progress_;
  RunTimer timer_;
  std::optional<double> saved_;  ///< by that timer [s]
};

/// The fact by which a kept run knows its ensemble and member.
constexpr const char* kept_member = "ensemble.member";

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
  const SolverState state = loop.stepper().solver().end_state();
  const RunEnd end = loop.end(state);
  const double outflow = loop.memory().outflow_volume;
  loop.history().conclude();
  say_sanity(sanity_of(end, loop.history().rows(), outflow));
  MemberRun run;
  run.maps = final_maps(end, loop.stepper().solver().thickness());
  run.result = measured(run.maps, run.maps.threshold);
  run.result.at_gauges = measured_at(plan->options.gauges, run.maps);
  const SlideVolumes volumes = slide_volumes(end, outflow);
  run.result.volume_released = volumes.released;
  run.result.volume_final = volumes.final;
  run.result.volume_outflow = outflow;
  run.result.time_end = loop.stepper().time();
  run.result.steps = static_cast<double>(state.clock.step);
  run.result.wall_time = timer.seconds();
  return run;
}

bool run_members(const Members& members, EnsembleCounts& counts, const MembersPlan& plan) {
  const std::vector<std::int64_t> waiting = waiting_in(counts);
  Tallying tallying(counts, waiting.size(), plan);
  side_by_side(waiting.size(), plan.devices, [&](std::size_t place, const AnyDevice& device) {
    tallying.count(waiting[place], outcome_of(members, waiting[place], device, plan.edge_fails));
  });
  return tallying.is_whole();
}

void keep_runs(StageContext& context, const Members& members, const EnsembleOptions& options,
               const EnsemblePaths& paths, const AnyDevice& device, const EnsembleCounts& counts) {
  for (std::int64_t k = counts.part.first; k < counts.part.end; ++k) {
    if (!options.keeps("all") && !options.keeps(std::to_string(k))) continue;
    if (counts.state_of(k) == MemberState::left_out) continue;
    const RunPaths files(paths.run_folder(k));
    const std::string mark = fmt::format("{} {}", counts.fingerprint, k);
    if (std::filesystem::exists(files.run) && fact(run_facts(files.run), kept_member) == mark) {
      remove_leftovers(files);
      continue;
    }
    log_info(fmt::format("member {}: its whole run is kept", k));
    std::optional<Simulation> simulation;
    Facts facts{{kept_member, mark}};
    std::string failure = failure_of([&] {
      const auto own = members.plan(k);
      facts.insert(facts.begin(), own->domain->provenance.begin(), own->domain->provenance.end());
      simulation.emplace(own, device, files, mark);
    });
    if (failure.empty()) {
      make_folder(paths.run_folder(k));
      take_up(*simulation, {.resume = true}, files, mark);
      try {
        simulation->run(context.recipe.scene_name(), fmt::format("{}, member {}", context.recipe.title(), k), facts);
        context.results.push_back(files.run);
      } catch (const NumericalError& error) {  // all else that goes wrong here is the disk's
        failure = error.what();
      }
    }
    // It is counted as failed when its turn comes.
    if (!failure.empty()) warn("member-not-kept", fmt::format("member {} leaves no run: {}", k, failure));
  }
}

}  // namespace talus::solver
