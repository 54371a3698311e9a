// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The pulses of one inflow, and the points of each.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "solver/integrator/inflow.hpp"
#include "solver/scene/hydrograph.hpp"
#include "solver/scene/inflow_line.hpp"
#include "solver/scene/inflow_section.hpp"

namespace talus::solver {

/// A pulse before it has its points: what passes from one time to another.
struct PulseTimes {
  double begin = 0, end = 0;  ///< [s]
  double volume = 0;          ///< [m3]
};

/// The times of the pulses until `end_time`: each lets in what has gone `way` [m, horizontally] since the one before;
/// their volumes are the hydrograph's between those times, so that they add up to its integral.
std::vector<PulseTimes> pulse_times(const Hydrograph& hydrograph, const InflowSection& section, double way,
                                    double end_time);

/// What the points of an inflow have in common.
struct InflowMatter {
  int release = 0, material = 0;
  double density = 0;                    ///< [kg/m3]
  Vec3<double> gravity;                  ///< [m/s2]
  std::array<int, 3> points_per_cell{};  ///< along, across, up
};

/// The maker of the points of an inflow.
class InflowSeeder {
 public:
  /// The constructor keeps references to line and section, and to what `terrain` refers to.
  InflowSeeder(const InflowLine& line, const InflowSection& section, const InflowTerrain& terrain,
               const InflowMatter& matter)
      : line_(line), section_(section), terrain_(terrain), matter_(matter) {}

  /// The method appends the points of a pulse to `inflow`, and the pulse itself; their ids are left at 0. It throws
  /// DataError where they would stand outside the known ground; `place` names the inflow.
  void add(const PulseTimes& times, const std::string& place, Inflow& inflow) const;

 private:
  struct Strip;
  void add_strip(const Strip& strip, const std::string& place, Inflow& inflow) const;
  void add_point(const Strip& strip, double way, double height, Inflow& inflow) const;
  void sum_up(const ParticleState& points, std::size_t p, InflowPulse& pulse) const;

  const InflowLine& line_;
  const InflowSection& section_;
  InflowTerrain terrain_;
  InflowMatter matter_;
};

}  // namespace talus::solver
