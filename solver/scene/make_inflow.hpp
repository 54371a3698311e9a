// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The points that enter a scene over time, from the recipe's inflows (T44): the line that they enter through, the
// section of ground that its discharge fills, its pulses and their points.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/map/raster.hpp"
#include "solver/grid/terrain.hpp"
#include "solver/integrator/scene.hpp"
#include "solver/options/inflow.hpp"
#include "solver/options/solve.hpp"
#include "solver/scene/tables.hpp"

namespace talus::solver {

/// A flow through a section whose surface is level across it.
struct SectionFlow {
  double level = 0;  ///< of the surface, as the section's ground is measured [m]
  double area = 0;   ///< vertical, across the flow [m2]
  double width = 0;  ///< of what is covered, across the flow [m]
  double depth = 0;  ///< where it is deepest, vertical [m]
  double speed = 0;  ///< horizontal [m/s]
};

/// The ground along the line of an inflow, in strips of one width.
struct InflowGround {
  std::vector<double> height;  ///< of each strip [m]
  double strip = 0;            ///< width of one across the flow [m]
  double slope = 0;            ///< mean, along the flow; falling ground is negative [-]
  double gravity = 9.81;       ///< [m/s2]
};

/// The section of an inflow (T45), which fills like a channel: level across, over as much of the line as that takes.
class InflowSection {
 public:
  /// The constructor takes the ground, and which of speed, depth and Froude number is given.
  InflowSection(InflowGround ground, const InflowOptions& options);

  /// The flow of a discharge > 0 [m3/s].
  SectionFlow flow(double discharge) const;
  /// The vertical thickness of a flow over each strip [m].
  std::vector<double> thickness(const SectionFlow& flow) const;
  /// The Froude number of a flow: speed along the ground over sqrt(g cos(slope) h), h the mean depth normal to it [-].
  double froude(const SectionFlow& flow) const;
  /// The length along the ground over the horizontal one [-].
  double along() const;

 private:
  SectionFlow filled_to(double level) const;
  SectionFlow filled_by(double area) const;
  SectionFlow critical(double discharge, double froude) const;

  InflowGround ground_;
  std::vector<double> sorted_;  ///< heights of the strips, the lowest first [m]
  std::optional<double> speed_, depth_, froude_;
};

/// A place on the map, or a way [cells from the first node].
using CellPlace = std::array<double, 2>;

struct InflowTerrain {
  const GridShape& shape;
  const TerrainTables& terrain;

  /// Whether a point may stand there.
  bool open(const CellPlace& at) const;
  /// The slope along x and y [-].
  CellPlace slope(const CellPlace& at) const;
};

/// The line of an inflow on the map, with the section of ground below it.
struct InflowLine {
  CellPlace from{}, to{};          ///< its ends
  CellPlace ahead{};               ///< unit vector of the flow on the map
  std::vector<CellPlace> middles;  ///< of the strips
  InflowGround ground;
};

/// The line of an inflow; `place` names it in messages. It throws RecipeError where the line lies outside the known
/// ground, or where nothing says which way the flow goes.
InflowLine inflow_line(const InflowOptions& options, const std::string& place, const MapGrid& map,
                       const InflowTerrain& terrain);

/// A pulse before it has its points: what passes from one time to another.
struct PulseTimes {
  double begin = 0, end = 0;  ///< [s]
  double volume = 0;          ///< [m3]
};

/// The times of the pulses until `end_time`: each lets in what has gone `way` [m, horizontally] since the one before;
/// their volumes are the hydrograph's between those times, so that they add up to its integral.
std::vector<PulseTimes> pulse_times(const Hydrograph& hydrograph, const InflowSection& section, double way,
                                    double end_time);

struct InflowMatter {
  int release = 0, material = 0;
  double density = 0;                    ///< [kg/m3]
  Vec3<double> gravity;                  ///< [m/s2]
  std::array<int, 3> points_per_cell{};  ///< along, across, up
};

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

/// What enters until the end of the run, with ids after the scene's `seeded` points. It throws RecipeError and
/// DataError where an inflow cannot be: no known ground, a flow deeper than wide or beyond 100 m/s, too many points.
Inflow make_inflow(const Domain& domain, const SolveOptions& options, const GridShape& shape,
                   const TerrainTables& terrain);

}  // namespace talus::solver
