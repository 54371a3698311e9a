// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of points that are stretched beyond what their law bears: no tearing in silence.
#pragma once

#include "solver/options/solve.hpp"
#include "solver/run/recorders/history.hpp"

namespace talus::solver {

/// The points of elastic bodies that are stretched far: beyond the stretch from which the nominal stress of their law
/// falls (Law::largest_strain), so that they are torn apart by the law and not by a strength; and so far that they lie
/// about a cell apart, where the functions of the grid hardly tie them to one another.
struct Overstretched {
  double points = 0;   ///< beyond what their law bears [-]
  double apart = 0;    ///< further than `widest_spacing` cells apart [-]
  double largest = 0;  ///< stretch of any point [-]
};

/// The recorder that counts them at each record. Scenes without an elastic law have none; with one a record takes the
/// points from the device. It ends a run whose body may have parted between its points, unless the recipe accepts a
/// "torn-body", or the functions are averaged over boxes that stretch with the points (gimp).
class StretchRecorder : public TableRecorder<Overstretched> {
 public:
  /// The distance between points of a body [cells] from which they part: at 0.65 to 0.8 a cantilever with three points
  /// along a cell came off its wall.
  static constexpr double widest_spacing = 0.65;

  StretchRecorder(const SolveOptions& options, const Scene& scene);
  static bool watches(const SolveOptions& options);  ///< whether some material of the scene has such a law
  bool judges() const override { return true; }
  void conclude(const RunHistory& history) const override;

 protected:
  std::vector<Overstretched> samples(const Instant& now) const override;

 private:
  /// What is looked for in a material.
  struct Limits {
    bool elastic;           ///< whether strain is stretch; else nothing is
    double largest_strain;  ///< principal, logarithmic, that its law bears [-]
  };
  static Limits limits_of(const MaterialOptions& material);

  /// The method throws NumericalError where points lie so far apart that their body may have torn.
  void refuse_torn(const Overstretched& found, double time) const;

  std::vector<Limits> limits_;  ///< of every material
  double cell_volume_;          ///< [m3]
  bool accepts_torn_;           ///< the recipe does, of functions that a body can tear off
  bool bears_gaps_;             ///< points apart are said at the end, and do not end the run
};

}  // namespace talus::solver
