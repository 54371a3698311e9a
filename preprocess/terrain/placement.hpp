// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace talus::preprocess {

/// How one survey is moved onto another.
struct Placement {
  double x = 0, y = 0, z = 0;         ///< added to its coordinates and heights [m]
  double tilt_x = 0, tilt_y = 0;      ///< rise added per metre east and north of the centre
  double centre_x = 0, centre_y = 0;  ///< [m]

  /// What is added to the height at a place [m].
  double rise(double at_x, double at_y) const { return z + tilt_x * (at_x - centre_x) + tilt_y * (at_y - centre_y); }
  /// True when it shifts on the map.
  bool moves() const { return x != 0 || y != 0; }
  /// True when it changes anything.
  bool given() const { return moves() || z != 0 || tilt_x != 0 || tilt_y != 0; }
};

}  // namespace talus::preprocess
