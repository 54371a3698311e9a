// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Tables over time from text files: hydrographs and accelerograms.
#pragma once

#include <utility>
#include <vector>

#include "solver/integrator/scene.hpp"
#include "solver/options/inflow.hpp"
#include "solver/options/loads.hpp"

namespace talus::solver {

/// A discharge over time: straight lines between its rows, none before the first and after the last.
class Hydrograph {
 public:
  /// The constructor takes times that grow [s] and discharges of 0 or more [m3/s].
  Hydrograph(std::vector<double> times, std::vector<double> discharges);

  /// The volume until a time [m3]; exact but for rounding.
  double volume_until(double time) const;
  /// The times from which and to which there is a discharge without a break [s], in order.
  std::vector<std::pair<double, double>> spells() const;
  /// The largest discharge [m3/s].
  double peak() const;
  /// The time of the last row [s].
  double end() const { return times_.back(); }

 private:
  std::vector<double> times_, discharges_, volumes_;  ///< volumes_: until each row [m3]
};

/// The hydrograph of an inflow, scaled; `place` names the inflow in messages. It throws DataError where the file cannot
/// be read or its rows cannot be: not in order, negative, less than two.
Hydrograph read_hydrograph(const InflowOptions& options, const std::string& place);

/// The shaking that the options ask for, in SI units, along x, y and z of the map, from `start` on; none where they
/// name neither record nor file. Throws DataError, with the line: no accelerogram (docs/reference/formats.md).
Shaking read_shaking(const ShakingOptions& options);

}  // namespace talus::solver
