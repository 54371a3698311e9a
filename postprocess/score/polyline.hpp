// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// What a line in the plane can do: be walked in even steps, and be smoothed.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/mobility.hpp"

namespace talus::postprocess {

using Polyline = std::vector<std::array<double, 2>>;  // [m]

/// Length along the line up to each vertex [m]. [line.size()]
std::vector<double> lengths_along(const Polyline& line);

/// A line with vertices at even distances, as near to `step` [m] as its length allows; ends stay.
Polyline resampled(const Polyline& line, double step);

/// Vertices averaged with their neighbours (1/4, 1/2, 1/4) so many times; ends stay. On vertices a step apart this is a
/// Gaussian of standard deviation step * sqrt(times / 2).
Polyline smoothed(Polyline line, int times);

/// Without the vertices nearer than `step` [m] to the one kept before, and without those that would turn the line by
/// more than a right angle. The first and the last stay.
Polyline without_returns(const Polyline& line, double step);

/// The cheapest way from cell to cell (eight neighbours; Dijkstra 1959) from one place to another, where a metre costs
/// the thickest value of the map over that of the cell: it keeps to the middle of the flow, and leaves it only where
/// there is no other way. Begins and ends at the places themselves. A place outside the grid is joined by a straight
/// line.
Polyline flow_path(const MapGrid& grid, const std::vector<double>& thickness, const Place& from, const Place& to);

}  // namespace talus::postprocess
