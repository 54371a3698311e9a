// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What the heights of a model say about themselves: steps that they come in, whether they vary as ground does, and
// level pieces that are no water.
#pragma once

#include <filesystem>
#include <vector>

#include "common/map/raster.hpp"

namespace talus::preprocess {

/// The step [m] of which all heights are multiples above the lowest; 0 where there is none of `least` [m] or more, for
/// fewer than three heights, and for planes, which rise by the same from cell to cell.
double common_step(const Raster& heights, double least);

/// How much heights change from cell to cell beside how much they go on changing: the median size of second over that
/// of first differences along rows and columns; NaN where the larger part of the model is level. Noise without a
/// relation between cells has 1.73, a random walk 1.41, fractal ground of Hurst exponent H the root of 4 - 4^H
/// (Mandelbrot & Van Ness 1968), and what is steeper than it is rough less. Real ground at hand in cells of 5 to 20 m:
/// 0.14 to 0.27, SRTM at 190 m 0.52; maps of slope, aspect, shade and roughness of the same ground 0.8 to 1.3.
double roughness_ratio(const Raster& heights);

/// The value that most cells hold exactly, and what lies around them.
struct LevelPiece {
  double value = 0;
  std::size_t cells = 0, valid = 0;  // of that value, and with any
  std::size_t first = 0;             // one of them
  double lower_rim = 0;              // the share of their neighbours of other heights that lie lower
};
LevelPiece most_common_height(const Raster& heights);

/// Lines between two rows or columns over which heights jump from rim to rim.
struct StraightJumps {
  std::size_t rows = 0, columns = 0;  // how many lie along rows, and along columns
  double size = 0;                    // the median jump of those [m]
  double at = 0;                      // northing or easting of the first [m]
};

/// Over a line, a jump is the difference of a pair less the mean of the differences before and after it. The line is
/// one where the median jump is above 0.1 m and twice the median change of slope over it (a bend of the ground alone
/// makes a half), and 90 % of the jumps, 40 at least, have its sign. Real ground at hand has at most 84 % (seven models
/// in cells of 5 to 190 m, 7,000 lines).
StraightJumps straight_jumps(const Raster& heights);

/// Whether a piece of ground is level in both surveys, as water is, to what they resolve: the range of 90 % of its
/// heights before, and that of the lower half after (where it fell, shores lie bare), is at most two levels of
/// detection (3.29 standard errors of one of two equal surveys are 1.2, and there are few cells), or 0.1 m: waves, and
/// the strips of an airborne survey. Heights of its cells [m], and their level of detection [m].
bool is_level(const std::vector<double>& before, const std::vector<double>& after, double detection);

/// Warnings of heights [m] that may be no heights of ground, each with the causes that it cannot tell apart:
/// "stepped-heights" (steps of 0.1 m and more), "noise-like-heights" (a ratio above 0.8, which is ground with H < 0.87
/// without a slope), "level-ground" (a twentieth of the cells hold one value exactly, and a tenth of what lies around
/// them is lower: no water lies so), "straight-jumps". `pieces` of one model are judged one by one, the ratio by its
/// median over them: water is as noisy as it is level.
void warn_of_statistics(std::vector<Raster> pieces, const std::filesystem::path& file);

}  // namespace talus::preprocess
