// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Small synthetic terrains, given by formulas: the same on every machine and at any cell size.
#pragma once

#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::samples {

using Outline = std::vector<std::array<double, 2>>;  // corners (x, y) [m], not closed

/// One polygon of a vector file; a thickness below 0 is left out.
struct Feature {
  std::string name;
  double thickness = -1;  // [m]
  Outline outline;
};

/// What one kind of terrain consists of: files by their stem.
struct Sample {
  std::vector<std::pair<std::string, Raster>> rasters;                 // STEM.tif, metres
  std::vector<std::pair<std::string, std::vector<Feature>>> outlines;  // STEM.geojson
};

inline constexpr int crs_epsg = 32633;                   // WGS 84 / UTM zone 33N: any metric CRS would do
inline constexpr double west = 400000, south = 5200000;  // corner of all samples [m]

/// A plane dipping 30 degrees east, 600 m x 300 m, with a box of 100 m x 80 m and 8 m vertical thickness to release:
/// "dem", "release_thickness", outline "release".
Sample inclined_plane(double cell);

/// A parabolic chute 200 m high that runs out on a flat, 800 m x 300 m, with a cap of 5 m to release
/// ("release_thickness"), and two fields of 2 m and 3 m thickness for releases by polygon ("release"): "dem".
Sample parabolic_chute(double cell);

/// A valley 960 m x 680 m: "before_dem", "after_dem" (a spoon-shaped scar in the western flank, and below it a deposit
/// of the same volume), outlines "source" and "surveyed_outline" (all ground the slide went over).
Sample valley(double cell);

/// The same valley as two surveys see it: both with noise, the later one 0.4 cells too far east, 0.7 too far south
/// and 1.3 m too high, with holes: "before_dem", "after_dem". Another seed is another noise.
Sample raw_valley(double cell, unsigned seed);

/// A rock slope of the proportions of Xinmo 2017: 3600 m x 1600 m, crest at 3431 m, river at 2250 m 2.6 km away;
/// "before_dem", and "after_dem" from which a scar of 4.2 million m3 below the crest (area A) and 1.6 million m3 of the
/// ground on the way (area B, at most 8 m deep) are missing.
Sample rock_slope(double cell);

/// Smooth noise in -1..1 (Perlin's gradient noise, 2002 weights) at (x, y), in wavelengths; the same for the same seed.
double noise(double x, double y, unsigned seed);

/// A raster over `width` x `height` metres of what `value(x, y)` says of places counted from the corner, rounded to cm.
template <class Value>
Raster raster_of(double width, double height, double cell, Value value) {
  Raster raster;
  raster.grid.columns = static_cast<int>(std::lround(width / cell));
  raster.grid.rows = static_cast<int>(std::lround(height / cell));
  raster.grid.west = west;
  raster.grid.south = south;
  raster.grid.cell = cell;
  for (int row = 0; row < raster.grid.rows; ++row) {
    for (int column = 0; column < raster.grid.columns; ++column) {
      const double z = value((column + 0.5) * cell, (row + 0.5) * cell);
      raster.values.push_back(static_cast<double>(static_cast<long long>(z * 100 + (z < 0 ? -0.5 : 0.5))) / 100);
    }
  }
  return raster;
}

}  // namespace talus::samples
