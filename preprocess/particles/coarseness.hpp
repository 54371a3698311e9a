// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Whether a grid is fine enough for what is released on it.
#pragma once

#include <cstddef>

#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"

namespace talus::preprocess {

/// How a release lies in its grid.
struct Fineness {
  double width = 0;   ///< four times its area over its outline: the side of a square, 0.8 of a disc's diameter [m]
  double median = 0;  ///< thickness, median by volume [m]
  double across = 0;  ///< cells across that width
  double layers = 0;  ///< layers over that thickness
};

/// That of a release of `thickness` [m] on layers of `layer_height` [m]; zeros without release.
Fineness fineness_of(const Raster& thickness, double layer_height);

/// Warns, with the numbers to put in, of fewer than eight cells across the release (half of its columns lie at its rim
/// then), and of fewer than two layers where the recipe gives their height.
void warn_of_coarseness(const Raster& thickness, double layer_height, std::size_t points, const GridOptions& grid);

}  // namespace talus::preprocess
