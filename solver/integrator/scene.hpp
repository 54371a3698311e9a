// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What an integrator starts from: the grid's shape, the material points, their loads, what they can touch, how the
// ground shakes, and what enters over time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/domain/active_cells.hpp"
#include "common/map/raster.hpp"
#include "solver/boundary/base_friction.hpp"
#include "solver/boundary/contact_points.hpp"
#include "solver/options/loads.hpp"
#include "solver/state/clock.hpp"
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

  bool any() const { return !pulses.empty(); }  ///< whether anything enters
  std::size_t points_in(std::int64_t passed) const {
    return passed > 0
               ? pulses[static_cast<std::size_t>(passed) - 1].first + pulses[static_cast<std::size_t>(passed) - 1].count
               : 0;
  }
  double volume(std::int64_t passed) const;                 ///< volume of the first `passed` pulses [m3]
  double energy(std::int64_t passed) const;                 ///< energy that they brought [J]
  Vec3<double> momentum(std::int64_t passed) const;         ///< momentum that they brought [kg m/s]
  ParticleState points_of(const InflowPulse& pulse) const;  ///< a copy of the points of one pulse
};

/// This function appends `count` points of a list from the `first` one on to another one.
void append_points(ParticleState& to, const ParticleState& from, std::size_t first, std::size_t count);

/// An accelerogram as a recipe asks for it, in SI units, along x, y and z of the map; empty where the ground rests.
struct Shaking {
  std::vector<ShakingSample> samples;  ///< none, or 2 and more, later and later

  bool acts() const { return !samples.empty(); }  ///< whether there is an accelerogram
  /// The accelerogram as it is seen on the host.
  ShakingView view() const { return {samples.data(), static_cast<int>(samples.size())}; }
  /// The end of the last sample [s]; 0 where the ground rests.
  double end() const { return acts() ? samples.back().time : 0; }
  /// The time of the first sample that is later than `time` by more than `least` [s]; infinite where there is none [s].
  double next_sample(double time, double least) const;
  double peak_acceleration() const;  ///< largest acceleration of any sample [m/s2]
  double peak_velocity() const;      ///< largest velocity at any sample [m/s]
  /// An upper bound of the difference between the velocities of the ground at any two samples [m/s].
  double velocity_range() const;
};

/// This function makes samples of accelerations: it adds the velocities of the ground (T41).
Shaking make_shaking(const std::vector<double>& times, const std::vector<Vec3<double>>& accelerations);

/// The force per volume of every load at a time [N/m3], in a step that began at `begin` [s]: what begins or ends at the
/// end of a step is none of that step's. `volumes`: of the particles that each pulls at [m3].
std::vector<Vec3<double>> load_densities(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes,
                                         double begin, double time);

/// Whether a load that pulls at something jumps at a time.
bool loads_jump(const std::vector<LoadOptions>& loads, const std::vector<double>& volumes, double time);

/// The scene that an integrator starts from, in SI units, on the host.
struct Scene {
  MapGrid map;
  GridShape grid;
  TerrainTables terrain;  ///< of that grid
  ActiveCells active;     ///< of the grid at the start, around the points; layers above the bed
  ParticleState points;
  std::vector<double> load_volumes;  ///< volume of the points each load pulls at [m3]
  std::vector<Bed<double>> bed;      ///< of every column; empty where it is the same everywhere
  std::vector<float> water_table;  ///< its depth at the start, normal to the bed, of every column; empty: no water [m]
  std::vector<double> erodible;    ///< vertical depth of ground that is eroded by rate, of every column; or empty [m]
  ContactPoints contacts;
  Shaking shaking;                         ///< of the ground
  Inflow inflow;                           ///< what enters over time
  std::vector<std::string> release_names;  ///< of the domain, then of the inflows
};

}  // namespace talus::solver
