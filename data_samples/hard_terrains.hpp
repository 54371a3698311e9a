// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Terrains that are as hard on a solver as real ones: rough, bent, steep to a cliff, open. Each is a ground and a
// release that lies on it, given by formulas, which can be laid on the map mirrored and at any angle.
#pragma once

#include <array>

#include "data_samples/terrains.hpp"

namespace talus::samples {

/// A ground and what is released on it. Their own x axis points down the slope, y to its left; both hold outside of
/// their rectangle too. Metres.
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
  /// "dem" and "release_thickness" on that map.
  Sample sample() const;
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

/// A gully 18 m deep in a slope of 27 degrees that bends by 45 degrees and back and ends on a fan, 640 m x 360 m, and
/// up to 5 m of mass at its head.
HardTerrain bent_gully();

/// A slope of 32 degrees that ends at a cliff of 40 m and 76 degrees, a bench of 50 m below it, and a lower slope of 30
/// degrees, 520 m x 300 m, and up to 5 m of mass above the cliff.
HardTerrain cliff_bench();

/// A slope of 32 degrees above an open fan of 11 degrees, 900 m x 700 m, and up to 18 m of mass that thins out on it to
/// about a metre.
HardTerrain thinning_slide();

/// A slope of sound rock, 30 degrees, that runs out on 4 degrees, 480 m x 260 m, under up to 16 m of weathered ground,
/// which lies there at rest: a scene for slope stability. The cover is what a scene calls its release.
HardTerrain weathered_slope();

/// The elevation [m] that a slope has lost at x: tangent `steep` up to `from`, `gentle` from `from + over` on, changing
/// smoothly between them.
double fall(double x, double steep, double gentle, double from, double over);

/// A range of wavelengths [m].
struct Waves {
  double longest, shortest;
};

/// A self-affine surface (Mandelbrot 1982; Hurst exponent 0.8): waves from the longest on, each half as long as the one
/// before and 2^-0.8 as high; the longest is at most 1 high.
double fractal(double x, double y, const Waves& waves, unsigned seed);

}  // namespace talus::samples
