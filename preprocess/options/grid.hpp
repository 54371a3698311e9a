// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The background grid and the material points in it.
#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/recipe/recipe.hpp"
#include "preprocess/options/fault.hpp"

namespace talus::preprocess {

/// What becomes of cells without elevation.
enum class EdgeNodata { refuse, outside };

/// The keys of [preprocess.grid].
struct GridOptions {
  double spacing = 0;       ///< [m]; 0: the cell of the first DEM
  double layer_height = 0;  ///< [m]; 0: by the thickness of the release (default_layer_height()), or spacing
  std::vector<int> points_per_cell{2, 2, 2};
  double jitter = 0;
  std::vector<double> extent;  ///< west, south, east, north [m]; empty: where all DEMs overlap
  EdgeNodata edge_nodata = EdgeNodata::refuse;

  /// Whether the grid is given without an elevation model, and each of its cells holds points.
  bool stands_alone() const {
    return spacing > 0 && is_length(spacing) && is_length(layer_height) && three_positive(points_per_cell);
  }
  void describe(recipe::Visitor& v) {
    v.number("spacing_m", spacing, recipe::not_negative,
             "horizontal spacing h of the grid; 0 = the cell of the first DEM");
    need(v, is_length(spacing), fmt::format("grid.spacing_m = {}", spacing), "it must be positive",
         "Give a length in metres, or 0 for the cell of the first DEM");
    v.number(
        "layer_height_m", layer_height, recipe::not_negative,
        "vertical spacing h_z of the grid; 0 = half the median thickness of the release (by volume), at most h; in a "
        "laboratory h");
    need(v, is_length(layer_height), fmt::format("grid.layer_height_m = {}", layer_height), "it must be positive",
         "Give a length in metres, or 0 for one that suits the release");
    v.integers("points_per_cell", points_per_cell, recipe::Range{1, 64}, "material points along x, y and height");
    need(v, three_positive(points_per_cell),
         fmt::format("grid.points_per_cell = [{}]", fmt::join(points_per_cell, ", ")),
         "it must be three positive integers: along x, y and height", "The usual is [2, 2, 2]");
    v.number("jitter", jitter, recipe::Range{0, 0.5},
             "random shift of the points, as a part of their spacing; equal for equal points");
    v.numbers(
        "extent_m", extent, recipe::any,
        "[west, south, east, north] of the working grid, as gdalwarp -te; empty = where all DEMs overlap, of more than "
        "4 million cells what the slide can reach");
    need(v, extent.empty() || (extent.size() == 4 && extent[0] < extent[2] && extent[1] < extent[3]),
         fmt::format("grid.extent_m = [{}]", fmt::join(extent, ", ")),
         "it must be west, south, east and north, west below east and south below north", "Sort them so");
    recipe::choice(
        v, "edge_nodata", edge_nodata, {{"refuse", EdgeNodata::refuse}, {"outside", EdgeNodata::outside}},
        "cells without elevation that reach the edge of the grid: refuse them, or leave them outside the domain");
  }

 private:
  static bool is_length(double value) { return value >= 0 && std::isfinite(value); }
  static bool three_positive(const std::vector<int>& numbers) {
    return numbers.size() == 3 && std::ranges::all_of(numbers, [](int n) { return n > 0; });
  }
};

}  // namespace talus::preprocess
