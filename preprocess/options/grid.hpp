// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The background grid and the material points in it.
#pragma once

#include <vector>

#include "common/recipe/recipe.hpp"

namespace talus::preprocess {

/// What becomes of cells without elevation.
enum class EdgeNodata { refuse, outside };

/// The keys of [preprocess.grid].
struct GridOptions {
  double spacing = 0;       ///< [m]; 0: the cell of the first DEM
  double layer_height = 0;  ///< [m]; 0: by the thickness of the release (default_layer_height()), or spacing
  std::vector<int> points_per_cell{2, 2, 2};
  double jitter = 0;
  int jitter_seed = 1;
  std::vector<double> extent;  ///< west, south, east, north [m]; empty: where all DEMs overlap
  EdgeNodata edge_nodata = EdgeNodata::refuse;

  /// Whether the grid is given without an elevation model, and each of its cells holds points.
  bool stands_alone() const;
  /// The method declares the keys with defaults, help and what they need of one another.
  void describe(recipe::Visitor& v);
};

}  // namespace talus::preprocess
