// Fields on the map grid that the solver keeps while it runs.
#pragma once

#include "solver/parallel/macros.hpp"

namespace talus {

/// Running maxima and arrival time as a kernel sees them, [rows * columns] each.
struct MapView {
  double* peak_thickness = nullptr;  // [m]
  double* peak_speed = nullptr;      // of the depth mean [m/s]
  double* peak_pressure = nullptr;   // density times speed squared [Pa]
  double* arrival = nullptr;         // [s], negative: not yet
  double threshold = 0;              // thickness from which speed, pressure and arrival count [m]
};

/// Running maxima of one column from its mass [kg] and momentum [kg m/s] at `time` [s].
TALUS_HD void record_column(const MapView& maps, int column, double mass, double momentum, double density,
                            double spacing, double time) {
  const double thickness = mass / (density * spacing * spacing);
  if (thickness > maps.peak_thickness[column]) maps.peak_thickness[column] = thickness;
  if (thickness < maps.threshold) return;
  const double speed = momentum / mass;
  if (speed > maps.peak_speed[column]) {
    maps.peak_speed[column] = speed;
    maps.peak_pressure[column] = density * speed * speed;
  }
  if (maps.arrival[column] < 0) maps.arrival[column] = time;
}

}  // namespace talus
