// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The state of a run between steps, kept on the device so that a batch of steps needs nothing from the host; gravity
// and the shaking of the ground as kernels see them.
#pragma once

#include <cmath>
#include <cstdint>

#include "solver/parallel/atomics.hpp"

namespace talus {

/// The reasons why a batch stopped before its last step.
enum Halt : int {
  running = 0,
  at_event = 1,    ///< time has reached next_event
  wants_sort = 2,  ///< a point has left its home cell's neighbourhood, or enough steps have passed
  failed = 3,      ///< a point's state is not a number
  climbed = 4      ///< a request to sort, of a point that has left its home across the layers
};

/// The maps of speed and pressure are recorded (T25) at every event, and between events as the fastest point has gone
/// so far since [columns] or so many steps were taken: what passes a cell is seen there several times.
inline constexpr double way_between_records = 0.25;
inline constexpr int steps_between_records = 8;

/// Bounds of the step size (T11), and the rates measured for them.
struct StepControl {
  double courant = 0;              ///< step_size = courant / rate
  double longest = 0;              ///< upper bound of the step size [s]
  std::uint32_t rate_bits = 0;     ///< largest (wave speed + speed) over cell of any point, as float bits [1/s]
  std::uint32_t speed_bits = 0;    ///< largest speed of any point [m/s]
  std::uint32_t fastest_bits = 0;  ///< the same, of all steps so far [m/s]
};

/// Velocity finer than the grid, which decays exponentially (T8a).
struct SubgridVelocity {
  double decay_time = 0;  ///< [s]; 0: none is kept
  double kept = 0;        ///< share kept by the present step
};

/// Requests to interrupt a batch of steps.
struct Alarms {
  int halt = running;     ///< read by kernels: do nothing when set
  int request = running;  ///< set by kernels, becomes halt at the next step's begin
  int failed_point = -1;  ///< id of a point whose state is not a number
};

/// Sort interval of the points. A point outside its sort cell's neighbourhood forces a sort.
struct SortPolicy {
  int steps_since = 0;
  int steps_between = 32;
};

/// Points that left the domain since the last sort.
struct Outflow {
  double volume = 0;  ///< [m3]
  int count = 0;
};

/// Cumulative energy losses (T24) and reaction of bed and walls, summed where `is_kept` is set.
struct EnergyBudget {
  int is_kept = 0;
  double bed_loss = 0;             ///< to bed and walls [J]
  double friction_loss = 0;        ///< of that, to friction on the bed [J]
  double drag_loss = 0;            ///< to tractions of the bed that act on columns: drag, cohesion [J]
  double landing_loss = 0;         ///< of columns' motion towards the bed [J]
  double holding_loss = 0;         ///< to the impulses that prevent separation from the bed [J]
  double damping_loss = 0;         ///< to Cundall's damping [J]
  double plastic_loss = 0;         ///< to plastic flow [J]
  double transfer_loss = 0;        ///< between points and grid [J]
  double shaking_work = 0;         ///< done by the shaking of the ground [J]
  double reaction[3] = {0, 0, 0};  ///< impulse of bed and walls on the mass [N s]
};

/// Recording interval of the maps of speed and pressure (T25).
struct MotionMapPolicy {
  double column_spacing = 1;                     ///< [m]
  double path_unrecorded = 0;                    ///< of the fastest point since the last record [columns]
  int steps_unrecorded = steps_between_records;  ///< since the last record; the first step records the initial state
  int is_due = 0;                                ///< read by kernels: the state before this step goes into the maps
};

/// Intervals at which water flows between the grains (T50): it goes slowly beside waves.
struct WaterPolicy {
  int steps_between = 0;         ///< 0: there is no water
  int is_due = 0;                ///< read by kernels: water flows in this step
  std::int64_t every_until = 0;  ///< it flows in every step before this one, for points that have come
  double last = 0;               ///< time at which it flowed last [s]
  double passed = 0;             ///< time between that and the flow before [s]
  double interval = 0;           ///< expected time from that to the next flow [s]
  double until = 0;              ///< time up to which it has flowed [s]
  double duration = 0;           ///< for which it flows now [s]
  double depths = 0;             ///< sum over the columns at the last flow, in whole parts of a layer
  double liquefied = 0;          ///< the same of those on whose bed grains bear less than a tenth of the load

  /// The share of the mass that is liquefied [-].
  double liquefied_share() const { return depths > 0 ? liquefied / depths : 0; }

  /// Whether water flows in the step after so many.
  TALUS_HD bool flows_after(std::int64_t steps) const {
    return steps_between > 0 && (steps % steps_between == 0 || steps < every_until);
  }
  /// The method takes account of points that come after so many steps: the first flow tells them what they bear, the
  /// second one the bed.
  void add_points(std::int64_t steps) { every_until = steps + 2; }
};
inline constexpr int steps_between_flows = 8;

/// Motion of the ground (T42).
struct GroundMotion {
  double acceleration[3] = {0, 0, 0};  ///< mean over the step [m/s2]
  double velocity[3] = {0, 0, 0};      ///< at the end of the step [m/s]
};

/// Simulation time, with everything that a batch of steps updates on the device.
struct Clock {
  double time = 0;        ///< at the end of the present step [s]
  double step_size = 0;   ///< [s]
  double next_event = 0;  ///< never stepped over [s]
  std::int64_t step = 0;
  int steps_ahead = 0;  ///< that the batch may still open
  unsigned ticket = 0;  ///< see OpenStep
  int accelerated = 0;  ///< point accelerations are valid: the last step was implicit
  Alarms alarms;
  StepControl control;
  SubgridVelocity subgrid;
  SortPolicy sorting;
  Outflow outflow;
  MotionMapPolicy motion_maps;
  WaterPolicy water;
  GroundMotion shaking;
  EnergyBudget budget;

  /// The share (T8a) of the velocity finer than the grid that a step of this length [s] keeps: what is lost depends on
  /// time, not on the number of steps.
  TALUS_HD double share_kept(double length) const {
    return subgrid.decay_time > 0 ? exp(-length / subgrid.decay_time) : 0;
  }

  /// The method halts where something is due before the next step. One thread, or the host after the last step.
  TALUS_HD void halt_where_due() {
    if (alarms.halt != running) return;
    if (control.speed_bits > control.fastest_bits) control.fastest_bits = control.speed_bits;
    if (alarms.request == failed) {
      alarms.halt = failed;
    } else if (alarms.request != running || sorting.steps_since >= sorting.steps_between) {
      alarms.halt = wants_sort;
    } else if (time >= next_event) {
      alarms.halt = at_event;
      record_motion();
    }
  }

  /// The longest step that the points allow (T11) [s].
  TALUS_HD double full_step() const {
    const double rate = positive_from_bits(control.rate_bits),
                 longest = rate > 0 ? control.courant / rate : control.longest;
    return longest > control.longest ? control.longest : longest;
  }

  /// The method opens the next step: it settles its size (T11), or halts. One thread.
  TALUS_HD void begin_step() {
    motion_maps.is_due = 0;
    water.is_due = 0;
    halt_where_due();
    if (alarms.halt != running) return;
    if (motion_maps.path_unrecorded >= way_between_records || motion_maps.steps_unrecorded >= steps_between_records)
      record_motion();
    const double begun = time, longest = full_step(), remaining = next_event - time;
    if (longest >= remaining) {
      step_size = remaining;
      time = next_event;
    } else {
      // Even steps up to the event: inertia by columns goes by the step, and steps that change in a pattern would feed
      // fast modes of a mass at rest.
      step_size = remaining / ceil(remaining / longest * (1 - 1e-12));
      time += step_size;
    }
    // As long as there is no point a step is as long as it may be, and tells nothing of the next ones.
    if (water.flows_after(step)) flow_water(begun, control.rate_bits > 0 ? water.steps_between * step_size : 0);
    subgrid.kept = share_kept(step_size);
    motion_maps.path_unrecorded +=
        static_cast<double>(positive_from_bits(control.speed_bits)) * step_size / motion_maps.column_spacing;
    ++motion_maps.steps_unrecorded;
    control.rate_bits = 0;
    control.speed_bits = 0;
    ++step;
    ++sorting.steps_since;
  }

  /// The method sets the shaking of the step that has been opened from the velocity of the ground at its end [m/s].
  /// What steps have of it adds up to the change of that velocity, whatever their length.
  TALUS_HD void shake(const Vec3<double>& velocity) {
    const double now[3] = {velocity.x, velocity.y, velocity.z};
    for (int a = 0; a < 3; ++a) {
      shaking.acceleration[a] = (now[a] - shaking.velocity[a]) / step_size;
      shaking.velocity[a] = now[a];
    }
  }
  /// The acceleration of the ground in the step [m/s2].
  TALUS_HD Vec3<double> ground_acceleration() const {
    return {shaking.acceleration[0], shaking.acceleration[1], shaking.acceleration[2]};
  }

  /// The method lets water flow at a time, up to the middle of the interval to the next flow [s]: its pressure stays
  /// over that interval, and has no lag.
  TALUS_HD void flow_water(double now, double interval) {
    const double until = now + 0.5 * interval;
    water.is_due = 1;
    water.passed = now - water.last;
    water.last = now;
    water.interval = interval;
    water.duration = until > water.until ? until - water.until : 0;
    water.until += water.duration;
    water.depths = water.liquefied = 0;
  }

  /// The method lets kernels record the maps of speed and pressure from the points as they are.
  TALUS_HD void record_motion() {
    motion_maps.is_due = 1;
    motion_maps.path_unrecorded = 0;
    motion_maps.steps_unrecorded = 0;
  }
};

/// A sample of an accelerogram; between samples the acceleration is linear.
struct ShakingSample {
  double time = 0;              ///< of the run [s]
  Vec3<double> acceleration{};  ///< of the ground [m/s2]
  Vec3<double> velocity{};      ///< of the ground, from rest before the first sample (T41) [m/s]
};

/// An accelerogram, its samples in the order of time. Before and after them the ground does not accelerate.
struct ShakingView {
  const ShakingSample* samples = nullptr;
  int count = 0;  ///< 0, or 2 and more

  TALUS_HD bool acts() const { return count > 0; }  ///< whether there is an accelerogram

  /// The velocity of the ground at a time (T41) [m/s].
  TALUS_HD Vec3<double> velocity_at(double time) const {
    if (!acts() || time <= samples[0].time) return {};
    if (time >= samples[count - 1].time) return samples[count - 1].velocity;
    const int k = before(time);
    const ShakingSample a = samples[k], b = samples[k + 1];
    const double into = time - a.time, share = into / (b.time - a.time);
    return a.velocity + (a.acceleration + (b.acceleration - a.acceleration) * (0.5 * share)) * into;
  }

 private:
  TALUS_HD bool holds(int k, double time) const { return samples[k].time <= time && time < samples[k + 1].time; }

  /// The sample before a time that lies within the accelerogram. Samples are mostly equally apart: then it is found at
  /// once.
  TALUS_HD int before(double time) const {
    const double first = samples[0].time, duration = samples[count - 1].time - first;
    int low = static_cast<int>((time - first) / duration * (count - 1)), high = count - 1;
    if (low > count - 2) low = count - 2;
    if (holds(low, time)) return low;
    low = 0;
    while (high - low > 1) {
      const int middle = low + (high - low) / 2;
      if (samples[middle].time <= time) {
        low = middle;
      } else {
        high = middle;
      }
    }
    return low;
  }
};

/// Gravity that grows to its full size from the start of a run.
template <class Real>
struct Gravity {
  Vec3<Real> full{};  ///< [m/s2]
  double ramp = 0;    ///< time over which it grows [s]; 0: there from the start

  /// The share of it that acts at a time [-].
  TALUS_HD double share(double time) const { return ramp > 0 && time < ramp ? time / ramp : 1; }
  /// The acceleration by which a step pulls, in the frame of the ground (T42): gravity, less what the ground
  /// accelerates by [m/s2].
  TALUS_HD Vec3<Real> at(const Clock& clock) const {
    return full * Real(share(clock.time)) - narrow<Real>(clock.ground_acceleration());
  }
};

}  // namespace talus
