// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A smooth sliding surface under a source known by its outline, and by a depth, a volume or points of depth. Rasters
// in, rasters out; no files.
#pragma once

#include <vector>

#include "common/map/raster.hpp"
#include "preprocess/release/outline.hpp"

namespace talus::preprocess {

/// A surface that meets the ground along an outline and lies nowhere above it.
struct SlidingSurface {
  Raster surface;                   // elevation [m]; outside the outline the ground itself
  double curvature = 0;             // q, the surface's Laplacian [1/m]; with points, the value it departs from least
  double depth = 0;                 // largest, vertical [m]
  double volume = 0;                // between surface and ground, cells counted by their covered part [m3]
  std::size_t touching = 0;         // cells inside at which the surface would stand above the ground, and follows it
  std::vector<double> misfit = {};  // at each depth point: computed less given depth [m]
};

/// A place at which the sliding surface is known.
struct DepthPoint {
  double x = 0, y = 0;  // [m]
  double depth = 0;     // vertical, below the surface before [m]
  double error = 0;     // its standard error [m]; 0: met exactly
};

/// laplace(z) = q with z = ground on the outline and z <= ground within, q such that the largest depth (or the volume)
/// is the one given: the surface of least bending in the sense of Jaboyedoff et al. 2004 (sloping local base level) and
/// Kuo et al. 2020 (least area under a given volume), (T21) and (T22) in docs/explanation/theory.md. `depth` and
/// `volume` > 0; they are met to rounding. All cells of the outline need elevations. Throws NumericalError.
SlidingSurface surface_of_depth(const Raster& before, const Outline& outline, double depth);
/// The sliding surface with that volume between it and the ground [m3].
SlidingSurface surface_of_volume(const Raster& before, const Outline& outline, double volume);

/// The surface of least integral (laplace(z) - q)^2, q free, that meets the points: exactly, or as a whole within their
/// errors (mean square of misfit over error 1: Reinsch 1967), (T23). Where it would stand above the ground it is cut
/// off there. Every point must lie within the outline; at least one.
SlidingSurface surface_through(const Raster& before, const Outline& outline, const std::vector<DepthPoint>& points);

/// The value of a raster between the centres of four cells, bilinear; at its edge that of the nearest.
double value_at(const Raster& raster, double x, double y);

/// Vertical thickness between the ground and a surface under it, cells counted by their covered part [m].
Raster thickness_above(const Raster& surface, const Raster& before, const Outline& outline);

}  // namespace talus::preprocess
