// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The deposits of two runs against one another.
#pragma once

#include "common/map/raster.hpp"
#include "common/run/run_file.hpp"

namespace talus::postprocess {

/// How far two deposits differ, on the first one's grid.
struct DepositDifference {
  Raster difference;   ///< second less first, vertical [m]; NaN where both are outside
  double larger = 0;   ///< largest gain [m]
  double smaller = 0;  ///< largest loss, as a positive number [m]
  double p99 = 0;      ///< 99 % of the cells where either is thicker than the threshold differ by less [m]
  double volume = 0;   ///< of the second less that of the first [m3]
  double moved = 0;    ///< share of the first deposit that lies elsewhere in the second, volumes set equal [-]
  double overlap = 0;  ///< area of both over area of either, where thicker than the threshold [-]
  double rms = 0;      ///< over the area of either [m]
};

/// Compares the deposits; the second is brought to the first one's grid by area weights, which keep its volume. Throws
/// DataError where the coordinate systems differ.
DepositDifference deposit_difference(const RunMaps& first, const RunMaps& second, double threshold);

}  // namespace talus::postprocess
