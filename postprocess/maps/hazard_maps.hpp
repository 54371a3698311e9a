// SPDX-FileCopyrightText: The Talus authors
// SPDX-License-Identifier: GPL-3.0-or-later
// Intensity, reach and buildings as files for a GIS.
#pragma once

#include <filesystem>
#include <vector>

#include "common/qgis/project.hpp"
#include "common/run/run_file.hpp"
#include "postprocess/hazard/hazard.hpp"

namespace talus::postprocess {

/// Write what there is of intensity.tif, reach_cone.tif (the first cone), each with its style, reach.gpkg (the outline
/// of every cone, `angle_deg`, `h_over_l`) and buildings.gpkg (layers `buildings` and `obstacles`) into `folder`.
/// Returns the files. Throws DataError.
std::vector<std::filesystem::path> write_hazard_maps(const std::filesystem::path& folder, const Run& run,
                                                     const Hazard& hazard);

/// The layers of a project that show them: outlines first, then rasters.
std::vector<ProjectGroup> hazard_groups(const Hazard& hazard);

}  // namespace talus::postprocess
