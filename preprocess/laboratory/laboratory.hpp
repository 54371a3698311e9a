// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Laboratory scenes: boxes of material on or above a plane, without any elevation model.
#pragma once

#include "common/domain/domain.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/releases.hpp"

namespace talus::preprocess {

// All of these expect options that recipe::find_unmet() finds nothing in.

/// ground_m + slope_x (x - west_m) + slope_y (y - south_m) at the cells' centres.
Raster laboratory_ground(const Options& options);

/// A box as a vertical thickness: its height times the part of each cell that it covers. Under a sloping top, that of
/// the points.
Release box_release(const Options& options, std::size_t item);

/// The ground with the tops of the boxes on it, each weighed by the part of the cell it covers.
Raster box_surface(const Options& options, const Raster& ground);

/// The number of material points that seed_boxes() would make.
std::size_t count_box_points(const Options& options);

/// Points of all boxes on a regular lattice that starts half a spacing inside each box's lower south-western corner,
/// points_per_cell to a cell and a layer; each stands for the same part of its box. Under a top that slopes, those are
/// left out whose places lie above it. grid.jitter shifts them.
SeedPoints seed_boxes(const Options& options);

}  // namespace talus::preprocess
