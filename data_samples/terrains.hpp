// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Small synthetic terrains, given by formulas: the same on every machine and at any cell size. Some are as hard on a
// solver as real ones: rough, bent, steep to a cliff, open.
#pragma once

#include <algorithm>
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
  for (int row = 0; row < raster.grid.rows; ++row)
    for (int column = 0; column < raster.grid.columns; ++column) {
      const double z = value((column + 0.5) * cell, (row + 0.5) * cell);
      raster.values.push_back(static_cast<double>(static_cast<long long>(z * 100 + (z < 0 ? -0.5 : 0.5))) / 100);
    }
  return raster;
}

/// A ground and what is released on it [m]. x points down the slope, y to its left; both hold outside of the rectangle.
struct HardTerrain {
  double width, height;                  ///< of the rectangle, along x and y [m]
  double (*ground)(double x, double y);  ///< elevation [m]
  /// Vertical thickness [m], on the ground.
  double (*release)(double x, double y);
};

/// How a terrain is laid on the map: mirrored left to right, then turned counter-clockwise.
struct Pose {
  bool mirrored = false;
  double turned_deg = 0;
};

/// A terrain on a map of its bounding rectangle, whose middle stays its middle.
class LaidTerrain {
 public:
  /// The constructor makes the map large enough, in whole cells [m].
  LaidTerrain(const HardTerrain& terrain, double cell, const Pose& pose);
  Sample sample() const;  ///< "dem" and "release_thickness" on that map
  /// A place of the map, counted from its corner, on the terrain's own axes [m].
  std::array<double, 2> own(double x, double y) const;

 private:
  HardTerrain terrain_;
  double cell_, along_, across_;  ///< along_, across_: cosine and sine of the turn
  double side_;                   ///< -1 where mirrored
  double width_, height_;         ///< of the map [m]
};

/// A fractal slope of 30 degrees that runs out on 4 degrees, 640 m x 320 m, and 0.5 to 1 m of mass on it: a self-affine
/// surface (Hurst exponent 0.8) of waves of 5 to 160 m, as high as the flow is thick where they are 20 m long.
HardTerrain rough_slope();

/// A gully 18 m deep in a slope of 27 degrees that bends by 45 degrees and back and ends on a fan; up to 5 m of mass.
HardTerrain bent_gully();

/// A slope of 32 degrees that ends at a cliff of 40 m and 76 degrees, a bench of 50 m below it, and a lower slope of 30
/// degrees, 520 m x 300 m, and up to 5 m of mass above the cliff.
HardTerrain cliff_bench();

/// A slope of 32 degrees above an open fan of 11 degrees, 900 m x 700 m; up to 18 m of mass that thins to a metre.
HardTerrain thinning_slide();

/// A slope of sound rock, 30 degrees, that runs out on 4 degrees, 480 m x 260 m, under up to 16 m of weathered ground,
/// which lies there at rest: a scene for slope stability. The cover is what a scene calls its release.
HardTerrain weathered_slope();

/// The elevation [m] lost by a slope at x: tangent `steep` up to `from`, then smoothly `gentle` from `from + over`.
double fall(double x, double steep, double gentle, double from, double over);

/// A range of wavelengths [m].
struct Waves {
  double longest, shortest;
};

/// A self-affine surface (Mandelbrot 1982; Hurst exponent 0.8): waves from the longest on, each half as long as the one
/// before and 2^-0.8 as high; the longest is at most 1 high.
double fractal(double x, double y, const Waves& waves, unsigned seed);

/// From 0 (t <= 0) to 1 (t >= 1) without a kink.
inline double smooth(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

/// Integral of smooth() from 0 to t.
inline double smooth_integral(double t) {
  const double c = std::clamp(t, 0.0, 1.0);
  return c * c * c - c * c * c * c / 2 + std::max(0.0, t - 1);
}

}  // namespace talus::samples
