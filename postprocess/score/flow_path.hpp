// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The way a flow took between two places.
#pragma once

#include <optional>
#include <vector>

#include "common/map/raster.hpp"
#include "common/run/mobility.hpp"
#include "postprocess/score/polyline.hpp"

namespace talus::postprocess {

/// The cheapest way from cell to cell (eight neighbours; Dijkstra 1959) from one place to another, where a metre costs
/// the thickest value of the map over that of the cell: it keeps to the middle of the flow, and leaves it only where
/// there is no other way. Begins and ends at the places themselves. A place outside the grid is joined by a straight
/// line.
Polyline flow_path(const MapGrid& grid, const std::vector<double>& thickness, const Place& from, const Place& to);

}  // namespace talus::postprocess
