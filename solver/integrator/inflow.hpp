// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What enters a scene over time: the points of every inflow, pulse by pulse.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "solver/state/particles.hpp"

namespace talus::solver {

/// What enters at one time: the volume that passed the line since the pulse before, over the way it has gone since.
struct InflowPulse {
  double time = 0;                   ///< [s]
  std::size_t first = 0, count = 0;  ///< its points in Inflow::points
  double volume = 0;                 ///< [m3]; the discharge over the time since the pulse before
  double energy = 0;                 ///< kinetic, and potential from the lowest ground [J]
  Vec3<double> momentum{};           ///< [kg m/s]
};

/// What an inflow does at most, for plan and log.
struct InflowSummary {
  std::string name;
  double from = 0, to = 0;  ///< with a discharge, no later than the run's end [s]
  double volume = 0;        ///< that enters [m3]
  double late_volume = 0;   ///< of the hydrograph after the end of the run [m3]
  double peak = 0;          ///< largest discharge [m3/s]
  double width = 0, depth = 0,
         speed = 0;   ///< of the flow then: across [m], where it is deepest [m], along the ground [m/s]
  double froude = 0;  ///< of the mean depth, normal to the ground [-]
};

/// The top of an inflow at its largest discharge: a place of the map, the surface of the flow there, and its speed.
struct InflowTop {
  double x = 0, y = 0, z = 0;  ///< map coordinates and elevation [m]
  double speed = 0;            ///< along the ground [m/s]
};

/// All inflows of a scene, from its start to its end. The points' ids follow those of the scene's.
struct Inflow {
  ParticleState points;                  ///< in the order of their entry
  std::vector<InflowPulse> pulses;       ///< by time
  std::vector<double> line_x, line_y;    ///< where each point passed its line [cells from the first node]
  std::vector<InflowSummary> summaries;  ///< of each inflow
  std::vector<InflowTop> tops;           ///< of each inflow

  /// Whether anything enters.
  bool any() const { return !pulses.empty(); }
  /// The number of points in the first `pulses`.
  std::size_t points_in(std::int64_t passed) const {
    return passed > 0
               ? pulses[static_cast<std::size_t>(passed) - 1].first + pulses[static_cast<std::size_t>(passed) - 1].count
               : 0;
  }
  /// The volume of the first `passed` pulses [m3].
  double volume(std::int64_t passed) const;
  /// The energy that they brought [J].
  double energy(std::int64_t passed) const;
  /// The momentum that they brought [kg m/s].
  Vec3<double> momentum(std::int64_t passed) const;
  /// A copy of the points of one pulse.
  ParticleState points_of(const InflowPulse& pulse) const;
};

/// This function appends `count` points of a list from the `first` one on to another one.
void append_points(ParticleState& to, const ParticleState& from, std::size_t first, std::size_t count);

}  // namespace talus::solver
