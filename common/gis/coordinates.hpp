// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Places and extents moved from one coordinate reference system to another.
#pragma once

#include <string>
#include <vector>

namespace talus {

/// A rectangle in map coordinates [m].
struct Extent {
  double west = 0, south = 0, east = 0, north = 0;
  /// True when it holds no area.
  bool empty() const { return !(west < east && south < north); }
};

/// Smallest rectangle in `to_wkt` around `extent` in `from_wkt`. Throws DataError.
Extent transform_extent(const Extent& extent, const std::string& from_wkt, const std::string& to_wkt);

/// Moves points (x[i], y[i]) in place. Throws DataError when one cannot be.
void transform_places(const std::string& from_wkt, const std::string& to_wkt, std::vector<double>& x,
                      std::vector<double>& y);

}  // namespace talus
