// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Fields on the map grid that the solver keeps while it runs.
#pragma once

#include "common/run/map_fields.hpp"
#include "solver/state/clock.hpp"

namespace talus {

/// The running maxima and arrival time as kernels see them, [rows * columns] each.
struct MapView : RunningMaps<double*> {
  double threshold = 0;  ///< thickness from which speed, pressure and arrival count [m]
};

/// The matter over a column of the map.
struct ColumnMatter {
  double mass;     ///< [kg]
  double density;  ///< [kg/m3]
  double spacing;  ///< between columns [m]

  /// Its vertical thickness [m].
  TALUS_HD double thickness() const { return mass / (density * spacing * spacing); }
};

/// This function updates the thickness and the arrival (T25) of one column at `time` [s].
TALUS_HD void record_column(const MapView& maps, int column, const ColumnMatter& matter, double time) {
  const double thickness = matter.thickness();
  if (thickness > maps.peak_thickness[column]) maps.peak_thickness[column] = thickness;
  if (thickness >= maps.threshold && maps.arrival_time[column] < 0) maps.arrival_time[column] = time;
}

/// This function updates the speed and the pressure (T25) of one column, from the momentum of its points [kg m/s].
TALUS_HD void record_motion(const MapView& maps, int column, const ColumnMatter& matter, double momentum) {
  if (!(matter.thickness() >= maps.threshold)) return;
  const double speed = momentum / matter.mass, pressure = matter.density * speed * speed;
  if (speed > maps.peak_speed[column]) maps.peak_speed[column] = speed;
  if (pressure > maps.peak_pressure[column]) maps.peak_pressure[column] = pressure;
}

/// The density of the matter over each column.
template <class Real>
struct ColumnDensity {
  Real uniform;           ///< where all points have the same [kg/m3]
  const double* volumes;  ///< of the matter over each column, where they differ [m3]; else null

  /// That of a column of a mass [kg].
  TALUS_HD double of(int column, double mass) const {
    return volumes && volumes[column] > 0 ? mass / volumes[column] : static_cast<double>(uniform);
  }
};

/// This function records speed and pressure of one column from the sums of its points, and clears them.
/// `motion`: mass [kg] and momentum [kg m/s], [rows * columns].
template <class Real>
TALUS_HD void record_motion_sums(const MapView& maps, int column, Vec4<Real>* motion,
                                 const ColumnDensity<Real>& density, Real spacing) {
  const Vec4<Real> sum = motion[column];
  motion[column] = Vec4<Real>{};
  if (!(sum.w > Real(0))) return;
  const double mass = static_cast<double>(sum.w);
  const Vec3<double> momentum{static_cast<double>(sum.x), static_cast<double>(sum.y), static_cast<double>(sum.z)};
  record_motion(maps, column, {mass, density.of(column, mass), static_cast<double>(spacing)}, length(momentum));
}

/// This function does so in a step in which the clock says that motion is recorded; `motion` may be null.
template <class Real>
TALUS_HD void record_motion(const MapView& maps, int column, const Clock& clock, Vec4<Real>* motion,
                            const ColumnDensity<Real>& density, Real spacing) {
  if (motion && clock.motion_maps.is_due != 0) record_motion_sums(maps, column, motion, density, spacing);
}

}  // namespace talus
