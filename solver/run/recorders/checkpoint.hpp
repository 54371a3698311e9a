// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// checkpoint.h5: everything from which --restart gives the result of an unbroken run.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/run/run_file.hpp"
#include "solver/integrator/solver.hpp"

namespace talus::solver {

/// The memory of the run itself between steps.
struct RunMemory {
  std::int64_t frames = 0, records = 0, checkpoints = 0;  ///< events passed
  std::int64_t newton = 0, linear = 0, cuts = 0;          ///< iterations and step cuts so far
  double peak_kinetic = 0;                                ///< [J]
  double outflow_volume = 0;                              ///< [m3]
  std::int64_t outflow_count = 0;
  std::int64_t pulses = 0;                   ///< of the inflows that have entered
  double wall_time = 0;                      ///< [s]
  std::vector<double> initial_thickness;     ///< [m]
  std::vector<double> section_x, section_y;  ///< where smallest parts of points were at the last record, for sections
  RunHistory history;
};

/// The scalars of the budget; see visit_clock().
template <class AnyBudget, class Item>
void visit_budget(AnyBudget& b, Item&& item) {
  item("keeps_budget", b.is_kept);
  item("bed_loss", b.bed_loss);
  item("friction_loss", b.friction_loss);
  item("drag_loss", b.drag_loss);
  item("landing_loss", b.landing_loss);
  item("holding_loss", b.holding_loss);
  item("damping_loss", b.damping_loss);
  item("plastic_loss", b.plastic_loss);
  item("transfer_loss", b.transfer_loss);
  item("shaking_work", b.shaking_work);
  item("reaction_x", b.reaction[0]);
  item("reaction_y", b.reaction[1]);
  item("reaction_z", b.reaction[2]);
}

/// This function calls item(name, scalar) for every scalar of a clock, with the names that a checkpoint has for them.
template <class AnyClock, class Item>
void visit_clock(AnyClock& c, Item&& item) {
  item("time", c.time);
  item("step_size", c.step_size);
  item("next_event", c.next_event);
  item("courant", c.control.courant);
  item("largest_step", c.control.longest);
  item("transfer_time_s", c.subgrid.decay_time);
  item("kept", c.subgrid.kept);
  item("outflow_volume", c.outflow.volume);
  item("step", c.step);
  item("rate_bits", c.control.rate_bits);
  item("speed_bits", c.control.speed_bits);
  item("fastest_bits", c.control.fastest_bits);
  item("halt", c.alarms.halt);
  item("request", c.alarms.request);
  item("steps_since_sort", c.sorting.steps_since);
  item("steps_between_sorts", c.sorting.steps_between);
  item("outflow_count", c.outflow.count);
  item("failed_point", c.alarms.failed_point);
  visit_budget(c.budget, item);
  item("accelerated", c.accelerated);
  item("column_spacing", c.motion_maps.column_spacing);
  item("way_unrecorded", c.motion_maps.path_unrecorded);
  item("steps_unrecorded", c.motion_maps.steps_unrecorded);
  item("records_motion", c.motion_maps.is_due);
  item("steps_between_flows", c.water.steps_between);
  item("flows", c.water.is_due);
  item("flows_each_step_until", c.water.every_until);
  item("flow_duration", c.water.duration);
  item("last_flow", c.water.last);
  item("passed_since_flow", c.water.passed);
  item("flow_interval", c.water.interval);
  item("flowed_until", c.water.until);
  item("depths", c.water.depths);
  item("liquefied_depths", c.water.liquefied);
  item("shaking_x", c.shaking.acceleration[0]);
  item("shaking_y", c.shaking.acceleration[1]);
  item("shaking_z", c.shaking.acceleration[2]);
  item("ground_velocity_x", c.shaking.velocity[0]);
  item("ground_velocity_y", c.shaking.velocity[1]);
  item("ground_velocity_z", c.shaking.velocity[2]);
}

/// This function calls item(name, value) for every scalar and list of a run's memory but its history, whose columns
/// have names of their own, with the names that a checkpoint has for them.
template <class AnyMemory, class Item>
void visit_memory(AnyMemory& m, Item&& item) {
  item("frames", m.frames);
  item("records", m.records);
  item("checkpoints", m.checkpoints);
  item("newton", m.newton);
  item("linear", m.linear);
  item("cuts", m.cuts);
  item("peak_kinetic", m.peak_kinetic);
  item("outflow_volume", m.outflow_volume);
  item("outflow_count", m.outflow_count);
  item("wall_time", m.wall_time);
  item("initial_thickness", m.initial_thickness);
  item("section_x", m.section_x);
  item("section_y", m.section_y);
  item("pulses", m.pulses);
}

struct Checkpoint {
  std::string fingerprint;  ///< of domain and settings; a checkpoint of other ones is refused
  std::string id;           ///< of the run, which its frames carry too
  std::string stop_reason;  ///< why the steps came to their end; empty where there are more to come
  SolverState state;
  RunMemory memory;
};

/// Writes a checkpoint to `file`, aside and renamed at the end. It throws DataError (disk full, not writable).
void write_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint);

/// What a look at a checkpoint tells, without reading the state.
struct CheckpointHead {
  std::string fingerprint;
  double time = 0;        ///< [s]
  std::int64_t step = 0;  ///< taken so far
};

/// The head of the checkpoint in `file`; none where there is no such file, or none that this version can read.
std::optional<CheckpointHead> look_at_checkpoint(const std::filesystem::path& file);

/// The checkpoint in `file`, bit for bit what was written. The function throws DataError when the file is missing,
/// truncated, changed since it was written, of another format number, made from another domain or other settings, or
/// inconsistent in itself.
Checkpoint read_checkpoint(const std::filesystem::path& file, const std::string& fingerprint);

/// This function throws DataError that names the first list, and the place in it, that does not fit: another count of
/// map cells or contact points, points outside the grid or far from their cell, of a release, load or material that the
/// scene does not have, two points of one id, a clock that ran backwards.
void check_checkpoint(const std::filesystem::path& file, const Checkpoint& checkpoint, const Scene& scene);

}  // namespace talus::solver
