// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells fail: by two surfaces (within a polygon, or a connected region of lowering), or under an outline alone.
#pragma once

#include <filesystem>
#include <vector>

#include "common/gis/raster_file.hpp"
#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/map/regions.hpp"
#include "preprocess/options/options.hpp"
#include "preprocess/release/sliding_surface.hpp"

namespace talus::preprocess {

/// What fails, and what it slides on.
struct Source {
  Raster thickness;  // vertical [m], 0 outside the source
  Raster bed;        // [m]
};

/// Two surfaces on the working grid; `under` may be nodata where there is no sliding surface.
struct SurfacePair {
  const Raster& before;
  const Raster& under;
  std::filesystem::path under_file;
  bool is_sliding_surface = false;
  std::vector<MapPolygon> outline = {};  // of the source, valid, where options.polygon names one
  std::vector<double> level = {};        // lowering from which on a cell counts, beside the threshold [m]; empty = any,
                                         // infinite = never
};

/// before less under where that is beyond its level, else 0 or the rise below 0 [m].
Raster detected_lowering(const SurfacePair& surfaces);

/// The regions of that lowering which may be the source, the largest by volume first. Throws DataError: none.
std::vector<Region> source_regions(const SurfacePair& surfaces, const Raster& lowering, const SourceOptions& options);

/// The source by its outline (cells on the outline count by their covered part), by its seed point, or the largest
/// region by volume; under a sliding surface a region goes on to where the surface meets the ground (1 mm). Where
/// levels of detection are given, lowered cells that a region encloses belong to it, though they are below their level.
/// Within it the bed is min(before, under), elsewhere before; so what was raised is no part of the bed. Throws
/// DataError: no lowering, nodata within the source, a sliding surface more than 0.1 m above the surface before within
/// the polygon.
Source find_source(const SurfacePair& surfaces, const SourceOptions& options);

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
/// `before`, a column named depth holds depths, and elevations must have the vertical datum of `heights`, which is that
/// of `before`.
ComputedSource source_by_outline(const Raster& before, const DeclaredHeights& heights, const SourceOptions& options,
                                 const ReadOptions& points);

}  // namespace talus::preprocess
