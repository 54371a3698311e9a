// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// The maps of an ensemble in files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "common/qgis/style.hpp"
#include "postprocess/ensemble/budget_table.hpp"
#include "postprocess/ensemble/ensemble.hpp"
#include "postprocess/ensemble/member_rows.hpp"
#include "postprocess/options/options.hpp"

namespace talus::postprocess {

/// Writes FOLDER/NAME.tif (cloud-optimised) and NAME.qml of every map, the ground with its hillshade, outlines.gpkg
/// (of every map of probability at 5, 50 and 95 %, and of the release) and
/// SCENE.qgs. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_probability_maps(const std::filesystem::path& folder, const Ensemble& ensemble,
                                                          const Options& options);

/// How a map of spread is drawn.
RasterStyle spread_style(const SpreadMap& map);

/// Writes the maps of spread of a budget, each with its style, the ground with its hillshade, outlines.gpkg (of the
/// release) and SCENE-budget.qgs. Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_spread_maps(const std::filesystem::path& folder, const Ensemble& ensemble,
                                                     const Options& options, const BudgetTable& table);

/// Writes probability.nc: CF-1.8, thresholds and quantiles as coordinates, the table of members as a group. Throws
/// DataError.
void write_probability_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                              const Options& options, const std::string& command_line);

}  // namespace talus::postprocess
