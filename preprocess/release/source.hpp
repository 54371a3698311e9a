// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Which cells fail, when two surfaces are given: a polygon, or a connected region of lowering.
#pragma once

#include <filesystem>
#include <vector>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "preprocess/options/options.hpp"

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
  std::vector<double> level = {};        // lowering from which on a cell counts, beside the threshold [m]; empty = any
};

/// The source by its outline (cells on the outline count by their covered part), by its seed point, or the largest
/// region by volume; under a sliding surface a region goes on to where the surface meets the ground (1 mm). Where
/// levels of detection are given, lowered cells that a region encloses belong to it, though they are below their level.
/// Within it the bed is min(before, under), elsewhere before; so what was raised is no part of the bed. Throws
/// DataError: no lowering, nodata within the source, a sliding surface more than 0.1 m above the surface before within
/// the polygon.
Source find_source(const SurfacePair& surfaces, const SourceOptions& options);

}  // namespace talus::preprocess
