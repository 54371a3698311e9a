// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Grids as a page can hold them: cut to the map shown, coarsened where they are large, quantised, deflated, base64.
#pragma once

#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/map/isolines.hpp"
#include "common/map/raster.hpp"
#include "common/run/map_fields.hpp"
#include "postprocess/fields/window.hpp"

namespace talus::postprocess {

/// Cells of `raster` that touch the window.
Raster cut(const Raster& raster, const Window& window);

/// Blocks of `factor` x `factor` cells made one, NaN left out (NaN where all are); an incomplete last row or column is
/// filled up with NaN.
Raster coarsened(const Raster& raster, int factor, MergedCells merge);

/// Smallest factor that leaves at most `cells` cells.
int factor_for(const MapGrid& grid, std::size_t cells);

/// Values as unsigned integers q with value = offset + step * (q - 1), and q = 0 for NaN: {"offset", "step", "bytes"}.
/// 16 bit, all high bytes before all low bytes, zlib stream, base64. The error is at most half a step, 1 / 131068 of
/// the range. Infinite values are not expected.
nlohmann::ordered_json packed(const std::vector<double>& values);

/// Several grids of one kind packed end to end, with one offset and step.
nlohmann::ordered_json packed(const std::vector<std::vector<double>>& frames);

/// Columns, rows, west, south and cell [m] of a grid.
nlohmann::ordered_json grid_json(const MapGrid& grid);

/// A line as a flat list x, y, x, y ... [m] from the window's corner, to a decimetre.
nlohmann::ordered_json line_json(const Polyline& line, const Window& window);
/// Several lines, a list each.
nlohmann::ordered_json lines_json(const std::vector<Polyline>& lines, const Window& window);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace talus::postprocess
