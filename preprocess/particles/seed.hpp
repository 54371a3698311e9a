// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Material points in the released mass: cell by cell, a column of the release's thickness at a time; and whether the
// grid is fine enough for it.
#pragma once

#include <cstddef>
#include <random>
#include <vector>

#include "common/domain/domain.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/releases.hpp"

namespace talus::preprocess {

/// Uniform in -size..size, the same in every run and on every machine (the standard's distributions are not).
class Shift {
 public:
  explicit Shift(double size) : size_(size) {}
  double operator()() { return size_ == 0 ? 0.0 : size_ * (2 * (static_cast<double>(random_() >> 11) * 0x1p-53) - 1); }

 private:
  double size_;
  std::mt19937_64 random_{1};
};

/// How densely to seed; see GridOptions.
struct Seeding {
  int along_x = 2, along_y = 2, in_height = 2;  // points per cell of the background grid
  double layer_height = 0;                      // h_z [m]
  double jitter = 0;                            // 0..0.5 of the points' spacing
};

/// The height of a layer where the recipe gives none [m]: half the median thickness, so that most of the release has
/// two layers or more, rounded down to two digits, and at most the spacing; the spacing without release.
double default_layer_height(const Raster& thickness, double spacing);

/// Seeding as the recipe says, with layers of this height [m].
Seeding seeding_of(const GridOptions& options, double layer_height);

/// Points for all releases, without making them.
std::size_t count_points(const std::vector<Release>& releases, const Seeding& seeding);

/// A column of vertical thickness T over a cell of side h gets n_x n_y n_z points of volume T h^2 / (n_x n_y n_z) each,
/// n_z = max(1, round(T / h_z * in_height)), evenly spaced: so the volumes sum to that of the rasters to rounding,
/// whatever the points per cell. Releases in one cell lie on one another, the first lowest.
///
/// A cell that a release covers so thinly, as at its rim, that its points would hold less than a tenth of those of the
/// thickest of its eight neighbours, gives its volume to the thicker ones of them: heavy points beside it would squash
/// such a point, whatever its own stress, until that stress throws it out.
SeedPoints seed_points(const std::vector<Release>& releases, const Seeding& seeding);

/// Warns, with the numbers to put in, of fewer than eight cells across the release (half of its columns lie at its rim
/// then), and of fewer than two layers where the recipe gives their height.
void warn_of_coarseness(const Raster& thickness, double layer_height, std::size_t points, const GridOptions& grid);

}  // namespace talus::preprocess
