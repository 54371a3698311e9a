// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// A page with its data: grids cut to the map shown, coarsened where they are large, quantised, deflated, base64.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/map/polygon.hpp"
#include "common/map/raster.hpp"
#include "common/run/map_fields.hpp"
#include "postprocess/fields/fields.hpp"

namespace talus::postprocess {

using Json = nlohmann::ordered_json;

/// The page without its data: page/ and the libraries it uses, put together when the program is built. The data belong
/// where "@DATA@" stands, the title where "@TITLE@" does, and the hashes of its scripts and styles where
/// "@HASHES_OF_SCRIPTS@" and "@HASHES_OF_STYLES@" do.
std::string_view page_template();

/// The page of an ensemble, likewise.
std::string_view ensemble_template();

/// The page with title and data in their places, and the hashes of all scripts and styles that a browser is to run.
std::string filled_page(std::string_view page, const std::string& title, const Json& data);

/// The source by which a Content-Security-Policy lets one inline script or style in, and no other: "'sha256-...'".
std::string policy_source(std::string_view inline_text);

/// Texts that name files, as a page may say them that is sent on: without the folders.
void leave_out_folders(Json& json);

/// Cells of `raster` that touch the window.
Raster cut(const Raster& raster, const Window& window);

/// Blocks of `factor` x `factor` cells, fewer at an edge, made one, NaN left out (NaN where all are).
Raster coarsened(const Raster& raster, int factor, MergedCells merge);

/// Smallest factor that leaves at most `cells` cells.
int factor_for(const MapGrid& grid, std::size_t cells);

/// Values as unsigned integers q with value = offset + step * (q - 1), and q = 0 for NaN: {"offset", "step", "bytes"}.
/// 16 bit, all high bytes before all low bytes, zlib stream, base64. The error is at most half a step, 1 / 131068 of
/// the range. Infinite values are not expected.
Json packed(const std::vector<double>& values);

/// Several grids of one kind packed end to end, with one offset and step.
Json packed(const std::vector<std::vector<double>>& frames);

/// Columns, rows, west, south and cell [m] of a grid.
Json grid_json(const MapGrid& grid);

/// What a map is drawn on: the window, and the ground with its hillshade.
Json ground_json(const Window& window, const Raster& elevation);

/// A line as a flat list x, y, x, y ... [m] from the window's corner, to a decimetre.
Json line_json(const Polyline& line, const Window& window);
/// Several lines, a list each.
Json lines_json(const std::vector<Polyline>& lines, const Window& window);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace talus::postprocess
