// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The source under an outline alone, or an outline and points of depth: what [preprocess.source.sliding_surface] asks
// for.
#pragma once

#include "common/gis/raster_file.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/sliding_surface.hpp"
#include "preprocess/release/source.hpp"

namespace talus::preprocess {

/// A source under an outline, and the sliding surface that was computed for it.
struct ComputedSource {
  Source source;
  SlidingSurface computed;
};

/// Volume of a slide of map area `area` [m2], 0.074 area^1.450 [m3], from 677 slides of 2 to 1e9 m2 (Guzzetti et al.
/// 2009, Earth Planet. Sci. Lett. 279, 222): the order of magnitude.
double volume_by_area(double area);

/// The surface through what is given (depth_m, volume_m3 or depth_points; else the volume_by_area(), with a warning)
/// and the source above it. Cells on the outline count by their covered part. Throws DataError: polygons that are not
/// valid or lie outside, ground without elevation within, depth points outside or above the ground. `points` says in
/// what unit depth points are (as vertical_unit of elevation models); those in degrees are brought to the CRS of
/// `before`, and a column named depth holds depths.
ComputedSource source_by_outline(const Raster& before, const SourceOptions& options, const ReadOptions& points);

}  // namespace talus::preprocess
