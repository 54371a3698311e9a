// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// How a survey's rasters come to one grid and one convention, and how far it may be off.
#pragma once

#include <filesystem>
#include <vector>

#include "common/run/run_file.hpp"
#include "postprocess/options/options.hpp"
#include "postprocess/survey/survey.hpp"

namespace talus::postprocess {

/// True where cells coincide to a millionth of a cell.
bool same_grid(const MapGrid& a, const MapGrid& b);

/// Throws DataError, with the command that mends it, unless the file's CRS is the run's.
void check_crs(const std::filesystem::path& file, const MapGrid& grid, const MapGrid& run);

/// A thickness on `grid`, by area weights where the grids differ.
std::vector<double> on_grid(const Raster& raster, const MapGrid& grid);

/// Values normal to the slope become vertical ones where the options say that they are, by the slope of the run's
/// ground.
void to_vertical(Raster& raster, const SurveyOptions& options, const RunMaps& maps);

/// Fill survey.error as the options say; nothing where they give no sigma. Measured values without a sigma become NaN,
/// and a note says how many. Warns where the range of the errors is not known though surveys are to be drawn. Throws
/// DataError: unreadable file, other CRS, negative sigma.
void read_error(const SurveyOptions& options, const RunMaps& maps, Survey& survey);

}  // namespace talus::postprocess
