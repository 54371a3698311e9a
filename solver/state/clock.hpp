// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Time, step and alarms, kept where the kernels run so that a batch of steps needs nothing from the host.
#pragma once

#include <cmath>
#include <cstdint>

#include "solver/parallel/atomics.hpp"
#include "solver/parallel/math.hpp"

namespace talus {

/// The reasons why a batch stopped before its last step.
enum Halt : int {
  running = 0,
  at_event = 1,    ///< time has reached next_event
  wants_sort = 2,  ///< a point has left its home cell's neighbourhood, or enough steps have passed
  failed = 3       ///< a point's state is not a number
};

/// The maps of speed and pressure are recorded (T25) at every event, and between events as the fastest point has gone
/// so far since [columns] or so many steps were taken: what passes a cell is seen there several times.
inline constexpr double way_between_records = 0.25;
inline constexpr int steps_between_records = 8;

/// The time, step and alarms of a run, and the sums that kernels keep for it.
struct Clock {
  double time = 0;            ///< at the end of the step under way [s]
  double step_size = 0;       ///< [s]
  double next_event = 0;      ///< never stepped over [s]
  double courant = 0;         ///< step_size = courant / rate
  double largest_step = 0;    ///< upper bound of step_size [s]
  double transfer_time = 0;   ///< over which velocity finer than the grid decays [s]
  double kept = 0;            ///< share of it that this step keeps
  double outflow_volume = 0;  ///< since the last sort [m3]
  std::int64_t step = 0;
  std::uint32_t rate_bits = 0;     ///< largest (wave speed + speed) over cell of any point, as float bits [1/s]
  std::uint32_t speed_bits = 0;    ///< largest speed of any point [m/s]
  std::uint32_t fastest_bits = 0;  ///< the same, of all steps so far [m/s]
  int halt = running;              ///< read by kernels: do nothing when set
  int request = running;           ///< set by kernels, becomes halt at the next step's begin
  int steps_since_sort = 0;
  int steps_between_sorts = 32;    ///< for the sake of the memory's order; a point that strays asks for one at once
  int outflow_count = 0;           ///< since the last sort
  int failed_point = -1;           ///< id of a point that failed
  int keeps_budget = 0;            ///< the sums below are kept
  double bed_loss = 0;             ///< energy lost so far to bed and walls [J]
  double friction_loss = 0;        ///< of that, to friction on the bed [J]
  double drag_loss = 0;            ///< to tractions of the bed that act on columns: drag, cohesion [J]
  double landing_loss = 0;         ///< of columns' motion towards the bed, which that took [J]
  double holding_loss = 0;         ///< to what holds columns on the bed that would leave it [J]
  double damping_loss = 0;         ///< to Cundall's damping [J]
  double plastic_loss = 0;         ///< to plastic flow [J]
  double transfer_loss = 0;        ///< between points and grid [J]
  double shaking_work = 0;         ///< done by the shaking of the ground so far [J]
  double reaction[3] = {0, 0, 0};  ///< impulse of bed and walls on the mass so far [N s]
  int accelerated = 0;             ///< the points know their acceleration: implicit steps were taken last
  double column_spacing = 1;       ///< between columns of the map [m]
  double way_unrecorded = 0;       ///< of the fastest point since the maps of speed were recorded [columns]
  int steps_unrecorded = steps_between_records;  ///< since then; the first step records what the mass starts with
  int records_motion = 0;  ///< read by kernels: the state before this step goes into the maps of speed and pressure
  double shaking[3] = {0, 0, 0};          ///< acceleration of the ground, its mean over the step (T42) [m/s2]
  double ground_velocity[3] = {0, 0, 0};  ///< at the end of the step [m/s]

  /// The share (T8a) of the velocity finer than the grid that a step of this length [s] keeps: what is lost depends on
  /// time, not on the number of steps.
  TALUS_HD double share_kept(double length) const { return transfer_time > 0 ? exp(-length / transfer_time) : 0; }

  /// The method halts where something is due before the next step. One thread, or the host after the last step.
  TALUS_HD void halt_where_due() {
    if (halt != running) return;
    if (speed_bits > fastest_bits) fastest_bits = speed_bits;
    if (request == failed) {
      halt = failed;
    } else if (request != running || steps_since_sort >= steps_between_sorts) {
      halt = wants_sort;
    } else if (time >= next_event) {
      halt = at_event;
      record_motion();
    }
  }

  /// The longest step that the points allow (T11) [s].
  TALUS_HD double full_step() const {
    const double rate = positive_from_bits(rate_bits), longest = rate > 0 ? courant / rate : largest_step;
    return longest > largest_step ? largest_step : longest;
  }

  /// The method opens the next step: it settles its size (T11), or halts. One thread.
  TALUS_HD void begin_step() {
    records_motion = 0;
    halt_where_due();
    if (halt != running) return;
    if (way_unrecorded >= way_between_records || steps_unrecorded >= steps_between_records) record_motion();
    const double longest = full_step(), remaining = next_event - time;
    if (longest >= remaining) {
      step_size = remaining;
      time = next_event;
    } else {
      // Even steps up to the event: inertia by columns goes by the step, and steps that change in a pattern would feed
      // fast modes of a mass at rest.
      step_size = remaining / ceil(remaining / longest * (1 - 1e-12));
      time += step_size;
    }
    kept = share_kept(step_size);
    way_unrecorded += static_cast<double>(positive_from_bits(speed_bits)) * step_size / column_spacing;
    ++steps_unrecorded;
    rate_bits = 0;
    speed_bits = 0;
    ++step;
    ++steps_since_sort;
  }

  /// The method sets the shaking of the step that has been opened from the velocity of the ground at its end [m/s].
  /// What steps have of it adds up to the change of that velocity, whatever their length.
  TALUS_HD void shake(const Vec3<double>& velocity) {
    const double now[3] = {velocity.x, velocity.y, velocity.z};
    for (int a = 0; a < 3; ++a) {
      shaking[a] = (now[a] - ground_velocity[a]) / step_size;
      ground_velocity[a] = now[a];
    }
  }
  /// The acceleration of the ground in the step [m/s2].
  TALUS_HD Vec3<double> ground_acceleration() const { return {shaking[0], shaking[1], shaking[2]}; }

  /// The method lets kernels record the maps of speed and pressure from the points as they are.
  TALUS_HD void record_motion() {
    records_motion = 1;
    way_unrecorded = 0;
    steps_unrecorded = 0;
  }
};

}  // namespace talus
