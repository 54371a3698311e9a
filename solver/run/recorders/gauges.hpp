// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Recorder of gauges: thickness, speed, elevation of the surface and pore pressure at points of the map.
#pragma once

#include "solver/options/solve.hpp"
#include "solver/run/recorders/history.hpp"

namespace talus::solver {

struct GaugeReading {
  double thickness;  ///< vertical, bilinear between the map's cells; ground that can be eroded counts too [m]
  double speed;      ///< of the mean velocity over depth, by mass, of the points within a cell; 0 where none is [m/s]
  double surface;    ///< elevation of the bed at the gauge itself, plus thickness [m]
  double pressure;   ///< of the water in the pores at the bed, of the load of the thickness [Pa]
};

/// The recorder that reads every gauge at each record. Without gauges there is no such recorder; with them a record
/// takes the points from the device.
class GaugeRecorder : public TableRecorder<GaugeReading> {
 public:
  /// The constructor throws RecipeError that names every gauge without terrain around it.
  GaugeRecorder(const SolveOptions& options, const Scene& scene);

 protected:
  std::vector<GaugeReading> samples(const Instant& now) const override;

 private:
  struct Site {
    double xi, eta;   ///< cells from the centre of the map's first one
    double bed;       ///< elevation [m]
    double load;      ///< across the bed of a metre of thickness [Pa/m]
    std::size_t low;  ///< the cell to the south-west of it
  };
  /// The value of a map at a gauge, bilinear.
  double at(const Site& site, const std::vector<double>& map) const;
  double speed_at(const Site& site, const ParticleState& points) const;

  std::vector<Site> sites_;
  std::size_t columns_;            ///< of the map
  std::vector<double> densities_;  ///< of every material [kg/m3]
};

}  // namespace talus::solver
