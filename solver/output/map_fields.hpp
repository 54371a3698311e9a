// Fields on the map grid that the solver keeps while it runs.
#pragma once

namespace talus {

/// Running maxima and arrival time as a kernel sees them, [rows * columns] each.
struct MapView {
  double* peak_thickness = nullptr;  // [m]
  double* peak_speed = nullptr;      // of the depth mean [m/s]
  double* peak_pressure = nullptr;   // density times speed squared [Pa]
  double* arrival = nullptr;         // [s], negative: not yet
  double threshold = 0;              // thickness from which speed, pressure and arrival count [m]
};

}  // namespace talus
