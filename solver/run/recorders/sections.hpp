// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of sections: what crosses lines of the map.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "solver/options/solve.hpp"
#include "solver/run/recorders/history.hpp"

namespace talus::solver {

/// Twice the signed area of the triangle a, b, c: positive where c lies to the left of the way from a to b.
double turn(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& c);

/// What the points of a line are shifted by before paths are held against it [cells]: points of a run lie on lattices,
/// lines at round coordinates, and where a corner of the one lies on the other a crossing is nobody's. So small a shift
/// moves no result, and no lattice of cells, nor of single precision about one, comes to lie on the line by it.
inline constexpr std::array<double, 2> off_lattice{0.7310585786e-9, 0.3678794412e-9};

/// How the straight path from `from` to `to` crosses the piece of a line from `a` to `b`: 1 from its left to its right,
/// -1 the other way, 0 not at all. Pieces that share an end, and paths that do, count a crossing once.
int crossing(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& from,
             const std::array<double, 2>& to);

/// The distance of a place from the piece of a line.
double distance(const std::array<double, 2>& a, const std::array<double, 2>& b, const std::array<double, 2>& place);

/// The numbers of a section, of the vertical surface over a line. Volumes are those released, as in all of a run.
/// "Crossed" counts what passes from the left of the line to its right, less what comes back.
struct SectionReading {
  double passed = 0;     ///< volume that crossed since the start [m3]
  double discharge = 0;  ///< volume that crossed since the record before, over that time [m3/s]
  double force = 0;      ///< momentum across the line that came so with it, over that time: rho v^2 A, either way [N]
  double area = 0;       ///< of the section through the mass, vertical: thickness along the line [m2]
  double thickness = 0;  ///< largest along the line now [m]
  double speed = 0;      ///< of the mean velocity, by mass, of the points within a cell of the line [m/s]
  double unseen = 0;     ///< volume that left the domain where it may have crossed unseen, since the start [m3]
};

/// The recorder that counts the points that cross each section between two records: each goes straight from where it
/// was at one to where it is at the next. A point is no place but stands for what is around it: it is held against
/// `copies` of the line, spread evenly over the width of a cell, and counts for each with its share, as the maps spread
/// it over the columns; rows of points would make the discharge jump otherwise. For a line that parts the domain the
/// volume that passed is so the change of the volume to its right, mean over the copies, to rounding; it is that of the
/// line itself once nothing is within half a cell of it. What enters by an inflow comes from its line. Without sections
/// there is no such recorder; with them a record takes the points from the device.
class SectionRecorder : public TableRecorder<SectionReading> {
 public:
  static constexpr int copies = 16;  ///< of a line, across the width of a cell

  /// Keeps a reference to the scene's inflow. Throws RecipeError that names every section beyond the domain.
  SectionRecorder(const SolveOptions& options, const Scene& scene);

  /// The method counts what crossed, and appends the numbers of every section.
  void record(const Instant& now, RunHistory& history) override;
  void keep(RunMemory& memory) const override;  ///< places of the points at the last record
  void restore(const RunMemory& memory) override;
  /// The lines on every section: the volume that passed, the largest discharge and its time.
  void conclude(const RunHistory& history) const override;

 protected:
  std::vector<SectionReading> samples(const Instant&) const override { return readings_; }

 private:
  using MapPlace = std::array<double, 2>;  ///< cells from the centre of the map's first one, east and north
  struct Line {
    std::string name;
    std::vector<MapPlace> places;
    std::vector<std::vector<MapPlace>> copies;
    MapPlace low, high;  ///< the box around the copies
  };
  struct Moment {
    const ParticleState& points;
    double since = 0;       ///< time since the record before; 0: there was none [s]
    double reach = 0;       ///< the furthest that a point went in that time [cells]
    std::size_t known = 0;  ///< points that have been in the domain by now, by id
  };
  static Line line_of(const SectionOptions& options, const MapGrid& map);
  void follow(const Moment& moment);
  void expect_inflow(std::size_t entered);
  void count(const Line& line, const Moment& moment, SectionReading& reading) const;
  void measure_surface(const Line& line, const std::vector<double>& thickness, SectionReading& reading) const;
  void measure_speed(const Line& line, const ParticleState& points, SectionReading& reading) const;
  void count_unseen(const Line& line, const Moment& moment, SectionReading& reading) const;
  double mass_of(const ParticleState& points, std::size_t p) const {
    return points.volume[p] * densities_[points.material_of(p)];
  }

  MapGrid map_;
  std::vector<double> densities_;  ///< of every material [kg/m3]
  std::vector<double> volumes_;    ///< of the points, by id [m3]
  std::vector<Line> lines_;
  std::vector<SectionReading> readings_;
  const Inflow& inflow_;
  std::size_t seeded_;         ///< points at the start
  std::vector<double> x_, y_;  ///< places at the last record, by id and smallest part [cells]; x < -1: gone
};

}  // namespace talus::solver
