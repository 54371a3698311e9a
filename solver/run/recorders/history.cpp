// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#include "solver/run/recorders/history.hpp"

#include <functional>

#include "solver/run/recorders/forces.hpp"
#include "solver/run/recorders/gauges.hpp"
#include "solver/run/recorders/sections.hpp"
#include "solver/run/recorders/stretch.hpp"

namespace talus::solver {
namespace {

constexpr Column<Instant> run_columns[] = {
    {"time_s", "s", [](const Instant& i) { return i.time; }},
    {"step", "1", [](const Instant& i) { return static_cast<double>(i.clock.step); }},
    {"step_size_s", "s", [](const Instant& i) { return i.clock.step_size; }},
    {"kinetic_J", "J", [](const Instant& i) { return i.energies.kinetic; }},
    {"potential_J", "J", [](const Instant& i) { return i.energies.potential; }},
    {"elastic_J", "J", [](const Instant& i) { return i.energies.elastic; }},
    {"volume_m3", "m3", [](const Instant& i) { return i.energies.volume; }},
    {"outflow_m3", "m3", [](const Instant& i) { return i.counted.outflow_volume; }},
    {"speed_max_m_s", "m s-1",
     [](const Instant& i) { return static_cast<double>(positive_from_bits(i.clock.control.speed_bits)); }},
    {"speed_max_so_far_m_s", "m s-1",
     [](const Instant& i) { return static_cast<double>(positive_from_bits(i.clock.control.fastest_bits)); }},
    {"moving_volume_m3", "m3", [](const Instant& i) { return i.energies.moving_volume; }},
    {"moving_speed_m_s", "m s-1", [](const Instant& i) { return i.energies.moving_speed(); }},
    {"momentum_x_kg_m_s", "kg m s-1", [](const Instant& i) { return i.energies.momentum.x; }},
    {"momentum_y_kg_m_s", "kg m s-1", [](const Instant& i) { return i.energies.momentum.y; }},
    {"momentum_z_kg_m_s", "kg m s-1", [](const Instant& i) { return i.energies.momentum.z; }},
    {"newton_iterations", "1", [](const Instant& i) { return static_cast<double>(i.counted.newton); }},
    {"linear_iterations", "1", [](const Instant& i) { return static_cast<double>(i.counted.linear); }},
    {"step_cuts", "1", [](const Instant& i) { return static_cast<double>(i.counted.cuts); }},
    {"step_over_cfl", "1", [](const Instant& i) { return i.step_over_cfl; }},
};

constexpr Column<Instant> budget_columns[] = {
    {"bed_loss_J", "J", [](const Instant& i) { return i.clock.budget.bed_loss; }},
    {"friction_loss_J", "J", [](const Instant& i) { return i.clock.budget.friction_loss; }},
    {"drag_loss_J", "J", [](const Instant& i) { return i.clock.budget.drag_loss; }},
    {"landing_loss_J", "J", [](const Instant& i) { return i.clock.budget.landing_loss; }},
    {"holding_loss_J", "J", [](const Instant& i) { return i.clock.budget.holding_loss; }},
    {"damping_loss_J", "J", [](const Instant& i) { return i.clock.budget.damping_loss; }},
    {"plastic_loss_J", "J", [](const Instant& i) { return i.clock.budget.plastic_loss; }},
    {"transfer_loss_J", "J", [](const Instant& i) { return i.clock.budget.transfer_loss; }},
    {"reaction_x_N_s", "N s", [](const Instant& i) { return i.clock.budget.reaction[0]; }},
    {"reaction_y_N_s", "N s", [](const Instant& i) { return i.clock.budget.reaction[1]; }},
    {"reaction_z_N_s", "N s", [](const Instant& i) { return i.clock.budget.reaction[2]; }},
};

constexpr Column<Instant> shaking_columns[] = {
    {"shaking_x_m_s2", "m s-2", [](const Instant& i) { return i.clock.shaking.acceleration[0]; }},
    {"shaking_y_m_s2", "m s-2", [](const Instant& i) { return i.clock.shaking.acceleration[1]; }},
    {"shaking_z_m_s2", "m s-2", [](const Instant& i) { return i.clock.shaking.acceleration[2]; }},
    {"ground_velocity_x_m_s", "m s-1", [](const Instant& i) { return i.clock.shaking.velocity[0]; }},
    {"ground_velocity_y_m_s", "m s-1", [](const Instant& i) { return i.clock.shaking.velocity[1]; }},
    {"ground_velocity_z_m_s", "m s-1", [](const Instant& i) { return i.clock.shaking.velocity[2]; }},
};

constexpr Column<Instant> shaking_budget_columns[] = {
    {"shaking_work_J", "J", [](const Instant& i) { return i.clock.budget.shaking_work; }},
};

/// What the inflows have brought by a record.
struct InflowReading {
  double volume = 0, energy = 0;  // [m3], [J]
  Vec3<double> momentum;          // [kg m/s]
};

constexpr Column<InflowReading> inflow_columns[] = {
    {"inflow_m3", "m3", [](const InflowReading& r) { return r.volume; }},
    {"inflow_energy_J", "J", [](const InflowReading& r) { return r.energy; }},
    {"inflow_momentum_x_kg_m_s", "kg m s-1", [](const InflowReading& r) { return r.momentum.x; }},
    {"inflow_momentum_y_kg_m_s", "kg m s-1", [](const InflowReading& r) { return r.momentum.y; }},
    {"inflow_momentum_z_kg_m_s", "kg m s-1", [](const InflowReading& r) { return r.momentum.z; }},
};

constexpr Column<Packing> packing_columns[] = {
    {"packing_p99", "1", [](const Packing& p) { return p.p99; }},
    {"packing_max", "1", [](const Packing& p) { return p.largest; }},
};

constexpr Column<Instant> water_columns[] = {
    {"liquefied_share", "1", [](const Instant& i) { return i.clock.water.liquefied_share(); }},
};

/// A recorder of the whole run, of the numbers that `measure` takes at a record, which a run may be judged by.
template <class Sample>
class RunRecorder : public TableRecorder<Sample> {
 public:
  using Measure = std::function<Sample(const Instant&)>;
  RunRecorder(std::span<const Column<Sample>> table, Measure measure)
      : TableRecorder<Sample>(table, {Place{}}), measure_(std::move(measure)) {}
  bool judges() const override { return true; }

 protected:
  std::vector<Sample> samples(const Instant& now) const override { return {measure_(now)}; }

 private:
  Measure measure_;
};

/// This function makes every recorder that the recipe asks for, in the order of their columns.
std::vector<std::unique_ptr<Recorder>> make_recorders(const SolveOptions& options, const Scene& scene) {
  std::vector<std::unique_ptr<Recorder>> recorders;
  const auto add_of_run = [&](std::span<const Column<Instant>> table) {
    recorders.push_back(std::make_unique<RunRecorder<Instant>>(table, [](const Instant& now) { return now; }));
  };
  add_of_run(run_columns);
  recorders.push_back(
      std::make_unique<RunRecorder<Packing>>(packing_columns, [](const Instant& now) { return now.solver.packing(); }));
  if (!scene.inflow.summaries.empty())
    recorders.push_back(
        std::make_unique<RunRecorder<InflowReading>>(inflow_columns, [&inflow = scene.inflow](const Instant& now) {
          const std::int64_t passed = now.counted.pulses;
          return InflowReading{inflow.volume(passed), inflow.energy(passed), inflow.momentum(passed)};
        }));
  if (GroundForceRecorder::measures(options)) recorders.push_back(std::make_unique<GroundForceRecorder>());
  if (options.energy_budget) add_of_run(budget_columns);
  if (options.shaking.acts()) {
    add_of_run(shaking_columns);
    if (options.energy_budget) add_of_run(shaking_budget_columns);
  }
  if (options.water.flows()) add_of_run(water_columns);
  if (!options.obstacles.empty()) recorders.push_back(std::make_unique<ObstacleRecorder>(options));
  if (!options.gauges.empty()) recorders.push_back(std::make_unique<GaugeRecorder>(options, scene));
  if (!options.sections.empty()) recorders.push_back(std::make_unique<SectionRecorder>(options, scene));
  if (StretchRecorder::watches(options)) recorders.push_back(std::make_unique<StretchRecorder>(options, scene));
  return recorders;
}

}  // namespace

History::History(const SolveOptions& options, const Scene& scene, HistoryUse use)
    : recorders_(make_recorders(options, scene)) {
  if (use == HistoryUse::judged) std::erase_if(recorders_, [](const auto& recorder) { return !recorder->judges(); });
  for (const auto& recorder : recorders_) recorder->add_columns(rows_);
}

void History::keep(RunMemory& memory) const {
  memory.history = rows_;
  for (const auto& recorder : recorders_) recorder->keep(memory);
}

void History::restore(const RunMemory& memory) {
  const RunHistory& rows = memory.history;
  for (HistoryColumn& column : rows_.columns) {
    const HistoryColumn* kept = rows.find(column.name);
    if (!kept || rows.columns.size() != rows_.columns.size())
      throw DataError({"the checkpoint's history has other columns than this run (" + column.name + ")",
                       "it is of another version of this program", "Run talus-solve again without --restart"});
    column.values = kept->values;
  }
  for (const auto& recorder : recorders_) recorder->restore(memory);
}

double History::last(const std::string& name) const {
  const HistoryColumn* column = rows_.find(name);
  return column && !column->values.empty() ? column->values.back() : 0;
}

}  // namespace talus::solver
