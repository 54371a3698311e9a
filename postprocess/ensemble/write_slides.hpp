// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Files of many slides: GeoTIFFs, outlines, a project of QGIS, NetCDF, the page.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "postprocess/ensemble/member_rows.hpp"
#include "postprocess/ensemble/page.hpp"
#include "postprocess/ensemble/slide_maps.hpp"

namespace talus::postprocess {

/// Writes into `folder` every map as a GeoTIFF that holds only tiles with values, with its style; ground.tif;
/// slides.gpkg (release, flow and deposit of each slide, with its row of the table); SCENE-slides.qgs. Returns the
/// files. Throws DataError.
std::vector<std::filesystem::path> write_slide_files(const std::filesystem::path& folder, const Ensemble& ensemble,
                                                     const MemberRows& rows);

/// Writes the table as NetCDF, and what it is of. Throws DataError.
void write_slides_netcdf(const std::filesystem::path& file, const Ensemble& ensemble, const MemberRows& rows,
                         const Options& options, const std::string& command_line);

/// What the page of many slides has of maps and outlines.
PageParts slide_page_parts(const EnsemblePageInput& input);

}  // namespace talus::postprocess
