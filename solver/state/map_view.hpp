// Fields on the map grid that the solver keeps while it runs.
#pragma once

#include "common/run/map_fields.hpp"
#include "solver/parallel/macros.hpp"
#include "solver/parallel/math.hpp"

namespace talus {

/// The running maxima and arrival time as kernels see them, [rows * columns] each.
struct MapView : RunningMaps<double*> {
  double threshold = 0;  ///< thickness from which speed, pressure and arrival count [m]
};

/// The matter over a column of the map.
struct ColumnMatter {
  double mass, momentum;  ///< [kg], [kg m/s]
  double density;         ///< [kg/m3]
  double spacing;         ///< between columns [m]
};

/// This function updates the running maxima (T25) of one column at `time` [s].
TALUS_HD void record_column(const MapView& maps, int column, const ColumnMatter& matter, double time) {
  const double thickness = matter.mass / (matter.density * matter.spacing * matter.spacing);
  if (thickness > maps.peak_thickness[column]) maps.peak_thickness[column] = thickness;
  if (thickness < maps.threshold) return;
  const double speed = matter.momentum / matter.mass;
  if (speed > maps.peak_speed[column]) {
    maps.peak_speed[column] = speed;
    maps.peak_pressure[column] = matter.density * speed * speed;
  }
  if (maps.arrival_time[column] < 0) maps.arrival_time[column] = time;
}

/// The recording of maps from sums over columns of nodes.
template <class Real>
struct ColumnRecorder {
  MapView maps;
  Real density;           ///< where all points have the same [kg/m3]
  const double* volumes;  ///< of the matter over each column, where they differ [m3]; else null

  /// The method records a column's mass [kg] and momentum [kg m/s] on nodes `spacing` apart [m] at `time` [s].
  TALUS_HD void record(int column, Real mass, const Vec3<Real>& momentum, Real spacing, double time) const {
    const double m = static_cast<double>(mass);
    const double mean = volumes && volumes[column] > 0 ? m / volumes[column] : static_cast<double>(density);
    record_column(maps, column, {m, static_cast<double>(length(momentum)), mean, static_cast<double>(spacing)}, time);
  }
};

}  // namespace talus
